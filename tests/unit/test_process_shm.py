"""Shared memory of killed nodes goes, that of living ones stays."""

from __future__ import annotations

import fcntl
from typing import TYPE_CHECKING

from launcher.process_shm import port_numbers, sweep, sweep_abandoned
from tests.half_made import make_old

if TYPE_CHECKING:
    from pathlib import Path

DEAD, ALIVE, GONE = "fastrtps_00000000000000d0", "fastrtps_00000000000000a1", "fastrtps_0"


def test_only_what_nobody_holds_is_removed(tmp_path: Path) -> None:
    for name in (DEAD, ALIVE):
        (tmp_path / name).write_bytes(b"segment")
        (tmp_path / f"{name}_el").touch()
    with (tmp_path / f"{ALIVE}_el").open() as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        assert sweep([DEAD, ALIVE, GONE], tmp_path) == [DEAD]
    assert sorted(path.name for path in tmp_path.iterdir()) == [ALIVE, f"{ALIVE}_el"]


def test_a_link_is_not_followed(tmp_path: Path) -> None:
    precious = tmp_path / "precious"
    precious.touch()
    (tmp_path / f"{DEAD}_el").symlink_to(precious)
    assert sweep([DEAD], tmp_path) == []
    assert precious.exists()


def test_ports_are_told_from_segments() -> None:
    assert port_numbers([DEAD, "fastrtps_port31413", "fastrtps_port7005"]) == [7005, 31413]


def made(path: Path, content: bytes, age_s: float = 60.0) -> Path:
    """A file that was written so long ago."""
    path.write_bytes(content)
    make_old([path], age_s)
    return path


def test_segments_that_were_abandoned_are_removed_and_ports_are_not(tmp_path: Path) -> None:
    port, fresh = "fastrtps_port7001", GONE.ljust(25, "f")
    for name in (DEAD, ALIVE, port, fresh):
        made(tmp_path / name, b"segment")
        made(tmp_path / f"{name}_el", b"", age_s=1.0 if name == fresh else 60.0)
    with (tmp_path / f"{ALIVE}_el").open() as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        assert sweep_abandoned(tmp_path) == [DEAD]
    kept = {path.name for path in tmp_path.iterdir()}
    assert kept == {name + end for name in (ALIVE, port, fresh) for end in ("", "_el")}


def test_where_there_is_no_shared_memory_nothing_is_swept(tmp_path: Path) -> None:
    assert sweep_abandoned(tmp_path / "none") == []

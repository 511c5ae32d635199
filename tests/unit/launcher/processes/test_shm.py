"""Shared memory of killed nodes goes, that of living ones stays."""

from __future__ import annotations

import fcntl
import os
from typing import TYPE_CHECKING

from launcher.processes.shared_memory import port_numbers, sweep, sweep_abandoned
from tests.unfinished_shared_memory import make_old

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

SEGMENT = b"\2" + bytes(4095)
"""As boost.interprocess leaves one that it has finished."""
DEAD, ALIVE, GONE = "fastrtps_00000000000000d0", "fastrtps_00000000000000a1", "fastrtps_0"


def test_only_what_nobody_holds_is_removed(tmp_path: Path) -> None:
    for name in (DEAD, ALIVE):
        (tmp_path / name).write_bytes(SEGMENT)
        (tmp_path / f"{name}_el").touch()
    with (tmp_path / f"{ALIVE}_el").open() as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        assert sweep([DEAD, ALIVE, GONE], tmp_path) == [DEAD]
    assert sorted(path.name for path in tmp_path.iterdir()) == [ALIVE, f"{ALIVE}_el"]


def test_what_is_not_of_fast_dds_or_not_the_users_own_stays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By name, content and owner: somebody may have given a file of his such a name."""
    text, lock, linked = (f"fastrtps_{number:016x}" for number in (1, 2, 3))
    for name in (text, lock, linked):
        (tmp_path / name).write_bytes(SEGMENT)
        (tmp_path / f"{name}_el").touch()
    (tmp_path / text).write_text("precious")
    (tmp_path / f"{lock}_el").write_text("precious")
    (tmp_path / "precious").hardlink_to(tmp_path / linked)
    before = sorted(tmp_path.iterdir())
    assert sweep([text, lock, linked], tmp_path) == []
    (tmp_path / "precious").unlink()
    with monkeypatch.context() as patch:
        patch.setattr(os, "geteuid", lambda: 4_000_000)
        assert sweep([linked], tmp_path) == []
    assert sorted(tmp_path.iterdir()) == [path for path in before if path.name != "precious"]
    assert sweep([linked], tmp_path) == [linked]


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
        made(tmp_path / name, SEGMENT)
        made(tmp_path / f"{name}_el", b"", age_s=1.0 if name == fresh else 60.0)
    with (tmp_path / f"{ALIVE}_el").open() as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        assert sweep_abandoned(tmp_path) == [DEAD]
    kept = {path.name for path in tmp_path.iterdir()}
    assert kept == {name + end for name in (ALIVE, port, fresh) for end in ("", "_el")}


def test_where_there_is_no_shared_memory_nothing_is_swept(tmp_path: Path) -> None:
    assert sweep_abandoned(tmp_path / "none") == []

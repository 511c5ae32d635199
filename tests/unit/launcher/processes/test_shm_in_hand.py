"""The mark of a message in hand is taken from the dead, and from nobody and nothing else."""

from __future__ import annotations

import fcntl
from pathlib import Path

import pytest

from launcher.processes.shared_memory_in_hand import release_in_hand
from tests.shared_memory_port import DOMAIN_AND_NAME
from tests.unit.launcher.processes.test_shm import made

PORT = "fastrtps_port7411"
BEFORE = bytes(20_000)
IN_USE, WAITING, IN_HAND = 1, 2, 4


def port_of(*slots: int) -> bytes:
    """A port whose first listeners are in these states."""
    each = b"".join(bytes([slot]).ljust(20, b"\7") for slot in slots)
    return BEFORE + each.ljust(1024 * 20, b"\0") + DOMAIN_AND_NAME + bytes(10_000)


def test_marks_of_the_dead_are_taken_away_and_all_else_stays(tmp_path: Path) -> None:
    path = made(tmp_path / PORT, port_of(IN_USE | IN_HAND, IN_HAND, IN_USE, IN_USE | 2 | IN_HAND))
    made(tmp_path / f"{PORT}_el", b"")
    assert release_in_hand(tmp_path) == [PORT]
    assert path.read_bytes() == port_of(IN_USE, IN_HAND, IN_USE, IN_USE | WAITING)
    assert release_in_hand(tmp_path) == []


@pytest.mark.parametrize("suffix", ["_el", "_sl"])
def test_the_living_keep_theirs(tmp_path: Path, suffix: str) -> None:
    path = made(tmp_path / PORT, port_of(IN_USE | IN_HAND))
    with made(tmp_path / f"{PORT}{suffix}", b"").open() as lock:
        fcntl.flock(lock, fcntl.LOCK_EX if suffix == "_el" else fcntl.LOCK_SH)
        assert release_in_hand(tmp_path) == []
    assert path.read_bytes() == port_of(IN_USE | IN_HAND)
    assert release_in_hand(tmp_path) == [PORT]


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\2",
        port_of(IN_USE | IN_HAND)[20_001:],
        port_of(IN_USE | IN_HAND).replace(b"abi5", b"abi6"),
    ],
)
def test_what_is_laid_out_otherwise_is_left_alone(tmp_path: Path, content: bytes) -> None:
    path = made(tmp_path / PORT, content)
    assert release_in_hand(tmp_path) == []
    assert path.read_bytes() == content


def test_only_ports_are_looked_at(tmp_path: Path) -> None:
    held = port_of(IN_USE | IN_HAND)
    precious = made(tmp_path / "precious", held)
    (tmp_path / PORT).symlink_to(precious)
    made(tmp_path / "fastrtps_0123456789abcdef", held)
    (tmp_path / "fastrtps_port7413").mkdir()
    (tmp_path / "fastrtps_port7415").hardlink_to(precious)
    assert release_in_hand(tmp_path) == []
    assert release_in_hand(tmp_path / "missing") == []
    assert precious.read_bytes() == held

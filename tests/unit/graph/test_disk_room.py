"""How fast a recording grows, and when its disk has no more room for it."""

from __future__ import annotations

from pathlib import Path

import pytest

from graph.bag.errors import BagError
from graph.recording.disk_room import DiskRoom, free_bytes

HERE = Path("/here/walk")
MB = 1_000_000


class Disk:
    """A disk of which somebody else may write away the room."""

    def __init__(self, free: int) -> None:
        self.free = free

    def __call__(self, folder: Path) -> int:
        assert folder == HERE
        if self.free < 0:
            raise PermissionError("not yours")
        return self.free


def test_the_rate_is_that_of_the_last_seconds() -> None:
    room = DiskRoom(HERE, 0, Disk(1000 * MB))
    for second in range(20):
        room.look(float(second), second * 8 * MB)
    assert room.bytes_per_s == pytest.approx(8 * MB)
    for second in range(20, 30):
        room.look(float(second), 19 * 8 * MB)
    assert room.bytes_per_s == 0.0
    assert room.left_s is None


def test_the_time_left_is_that_till_the_reserve() -> None:
    room = DiskRoom(HERE, 500 * MB, Disk(900 * MB))
    room.look(0.0, 0)
    assert room.left_s is None
    room.look(2.0, 16 * MB)
    assert room.left_s == pytest.approx(50.0)
    assert room.end is None


def test_at_the_reserve_it_ends_with_a_word() -> None:
    disk = Disk(501 * MB)
    room = DiskRoom(HERE, 500 * MB, disk)
    room.look(0.0, 0)
    assert room.end is None
    disk.free = 500 * MB
    room.look(1.0, MB)
    assert "500 MB are free on the disk of /here/walk" in str(room.end)


def test_where_there_is_no_room_it_does_not_begin() -> None:
    DiskRoom(HERE, 500 * MB, Disk(501 * MB)).check()
    with pytest.raises(BagError, match=r"/here/walk: 499 MB are free.*500 MB must stay free"):
        DiskRoom(HERE, 500 * MB, Disk(499 * MB)).check()


def test_a_disk_that_does_not_tell_ends_nothing() -> None:
    room = DiskRoom(HERE, 500 * MB, Disk(-1))
    room.check()
    room.look(0.0, 0)
    room.look(1.0, MB)
    assert (room.left_s, room.end) == (None, None)


def test_the_disk_of_a_folder_that_is_not_there_yet_is_that_of_its_parent(tmp_path: Path) -> None:
    assert free_bytes(tmp_path / "a" / "b") > 0

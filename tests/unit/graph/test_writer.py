"""The thread before the disk: a slow disk costs counted messages, a full one ends it in time."""

from __future__ import annotations

import resource
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from mcap.reader import make_reader

from graph.bag.errors import BagError
from graph.bag.reading import open_bag
from graph.recording.recorder import DiskRoom
from graph.recording.topics import Sequences
from graph.recording.writer import BagFile, BagTopic, Message, RecordingWriter

TEXT = "uint8[] data\n"


def topic() -> BagTopic:
    return BagTopic(1, "/big", "std_msgs/msg/UInt8MultiArray", "RIHS01_0")


class SlowFile(BagFile):
    """Takes nothing until it is let go."""

    def __init__(self, folder: Path) -> None:
        super().__init__(folder)
        self.gate = threading.Event()

    def write(self, topic: BagTopic, stamp_ns: int, sent_ns: int, raw: bytes) -> None:
        self.gate.wait(30)
        super().write(topic, stamp_ns, sent_ns, raw)


def test_what_finds_the_buffer_full_is_dropped_and_counted(tmp_path: Path) -> None:
    file, big = SlowFile(tmp_path / "bag"), topic()
    writer = RecordingWriter(file, limit_bytes=10_000)
    writer.add_topic(big, TEXT)
    for number in range(30):
        writer.put([Message(1 + number, big, bytes(1_000), 1)])
    assert writer.waiting_bytes <= 10_000
    assert writer.dropped["/big"] == 20
    file.gate.set()
    assert writer.finish(30)
    assert big.messages == 10
    with open_bag(tmp_path / "bag") as bag:
        assert bag.messages_count == 10
        assert not bag.is_cut


@contextmanager
def full_disk(room: int) -> Iterator[None]:
    """Let no file grow beyond so many bytes."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (room, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize("room", [1_100_000, 2_500_000, 3_150_000, 4_000_001])
def test_a_disk_that_fills_up_leaves_a_whole_bag(tmp_path: Path, room: int) -> None:
    file, big = BagFile(tmp_path / "bag"), topic()
    with full_disk(room):
        writer = RecordingWriter(file)
        writer.add_topic(big, TEXT)
        for number in range(100):
            writer.put([Message(1 + number, big, bytes([number]) * 100_000, 1)])
        assert writer.finish(30)
    assert "File too large" in str(writer.error)
    with file.path.open("rb") as stream:
        kept = [message.data[0] for _s, _c, message in make_reader(stream).iter_messages()]
    assert kept == list(range(len(kept)))
    assert len(kept) == big.messages == 100 - writer.dropped["/big"]
    assert len(kept) * 100_000 > room - 1_300_000
    assert not (tmp_path / "bag" / ".room").exists()
    with open_bag(tmp_path / "bag") as bag:
        assert (bag.messages_count, bag.notes) == (len(kept), ())


@pytest.mark.parametrize(
    ("numbers", "publishers", "missing"),
    [
        ([1, 2, 3], 1, 0),
        ([5, 6, 9], 1, 2),
        ([1, 1, 2, 2, 3, 3], 2, 0),
        ([1, 100, 2, 101, 103, 4], 2, 2),
        ([7, 8, 1, 2, 3], 1, 0),
        ([10, 12, 14], 0, 2),
        # The first one begins anew, and the second goes on.
        ([50, 90, 1, 91, 2], 3, 0),
    ],
)
def test_what_is_missing_is_found_in_the_numbers(numbers: list[int], publishers: int, missing: int) -> None:
    sequences = Sequences()
    assert sum(sequences.missing(number, lambda: publishers) for number in numbers) == missing


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

"""The thread before the disk: a slow disk costs counted messages, a full one the last chunk."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader
from mcap.stream_reader import CRCValidationError

from graph.bag.metadata import BagTopic
from graph.bag.reading import open_bag
from graph.recording.file import BagFile
from graph.recording.tap import Sequences
from graph.recording.writer import Message, RecordingWriter
from tests.waiting import wait_until

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


def test_a_flush_has_all_on_the_disk(tmp_path: Path) -> None:
    file, big = BagFile(tmp_path / "bag"), topic()
    writer = RecordingWriter(file)
    writer.add_topic(big, TEXT)
    writer.put([Message(1_000, big, b"\x00\x01\x00\x00" + b"here it is", 900)])
    wait_until(lambda: b"here it is" in file.path.read_bytes(), "the message on the disk")
    # As if the process were gone now.
    with open_bag(tmp_path / "bag") as bag:
        assert [raw for _topic, _stamp, raw in bag.messages()] == [b"\x00\x01\x00\x00here it is"]
        assert "was cut short" in " ".join(bag.notes)
    writer.finish(30)


class FullDisk:
    """A file in which there is room for so many bytes."""

    def __init__(self, file: Any, room: int) -> None:
        self._file = file
        self._room = room

    def write(self, data: Any) -> int:
        if self._file.tell() + len(data) > self._room:
            self._file.write(bytes(data)[: max(0, self._room - self._file.tell())])
            self._file.flush()
            raise OSError(28, "No space left on device")
        return int(self._file.write(data))

    def __getattr__(self, name: str) -> Any:
        return getattr(self._file, name)


@pytest.mark.parametrize("room", [1_100_000, 2_500_000, 3_150_000, 4_000_001])
def test_a_disk_that_fills_up_leaves_a_whole_bag(tmp_path: Path, room: int) -> None:
    file, big = BagFile(tmp_path / "bag"), topic()
    file._storage.bio = FullDisk(file._storage.bio, room)  # type: ignore[assignment]
    writer = RecordingWriter(file)
    writer.add_topic(big, TEXT)
    for number in range(100):
        writer.put([Message(1 + number, big, bytes([number]) * 100_000, 1)])
    assert writer.finish(30)
    assert "No space left on device" in str(writer.error)
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
def test_what_is_missing_is_found_in_the_numbers(
    numbers: list[int], publishers: int, missing: int
) -> None:
    sequences = Sequences()
    assert sum(sequences.missing(number, lambda: publishers) for number in numbers) == missing


def test_other_readers_find_both_times_and_check_the_sums(tmp_path: Path) -> None:
    file, big = BagFile(tmp_path / "bag"), topic()
    writer = RecordingWriter(file)
    writer.add_topic(big, TEXT)
    for number in range(5):
        writer.put([Message(1_000 + number, big, bytes([number]) * 400_000, 900 + number)])
    assert writer.finish(30)
    with file.path.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        times = [(one.log_time, one.publish_time) for _s, _c, one in reader.iter_messages()]
    assert times == [(1_000 + number, 900 + number) for number in range(5)]
    whole = bytearray(file.path.read_bytes())
    whole[whole.index(bytes([3]) * 400_000) + 9] = 77
    file.path.write_bytes(whole)
    with file.path.open("rb") as stream, pytest.raises(CRCValidationError):
        list(make_reader(stream, validate_crcs=True).iter_messages())

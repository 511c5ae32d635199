"""The files of a bag, whole or cut short, behind one way of reading them."""

from __future__ import annotations

import heapq
import struct
from collections.abc import Collection, Iterator
from contextlib import ExitStack, suppress
from typing import TYPE_CHECKING, Protocol

from rosbags.rosbag2 import Reader
from rosbags.rosbag2.storage_mcap import McapReader

from graph.words import Words, say

if TYPE_CHECKING:
    from pathlib import Path

    from rosbags.interfaces import Connection

MAGIC = b"\x89MCAP0\r\n"
OUT_OF_ORDER_NS = 3_000_000_000
"""Messages of a cut bag may be so much out of order: it was written topic by topic."""
FOOTER, DATA_END = 0x02, 0x0F
RECORD_HEAD = struct.Struct("<BQ")
Raw = tuple["Connection", int, bytes]


class BagReader(Protocol):
    """What a bag is read by."""

    connections: list[Connection]
    start_ns: int
    end_ns: int
    message_count: int
    distro: str

    def messages(self, start_ns: int | None, wanted: Collection[Connection]) -> Iterator[Raw]:
        """Yield messages of these connections in the order of their times."""

    def close(self) -> None:
        """Let go of the files."""


class WholeBag:
    """A bag with its index, by the library's reader."""

    def __init__(self, path: Path) -> None:
        """Raises whatever the library does for what it cannot read."""
        self._reader = Reader(path)
        self._reader.open()
        self.connections = list(self._reader.connections)
        self.message_count = self._reader.message_count
        self.start_ns = self._reader.start_time if self.message_count else 0
        self.end_ns = self._reader.end_time - 1 if self.message_count else 0
        self.distro = self._reader.ros_distro or ""

    def messages(self, start_ns: int | None, wanted: Collection[Connection]) -> Iterator[Raw]:
        """Yield messages of these connections in the order of their times."""
        return self._reader.messages(wanted, start_ns) if wanted else iter(())

    def close(self) -> None:
        """Let go of the files."""
        self._reader.close()


class CutFiles:
    """MCAP files of which the last has no end: read up to the last whole record."""

    distro = ""

    def __init__(self, paths: list[Path]) -> None:
        """Look through the files once. Raises ValueError and what the library raises."""
        self._stack = ExitStack()
        self._readers: list[McapReader] = []
        self._lost_bytes = 0
        self._is_cut = False
        try:
            for path in paths:
                self._readers.append(self._opened(path))
        except BaseException:
            self._stack.close()
            raise
        self.connections = [each for reader in self._readers for each in reader.connections]
        told = [reader.statistics for reader in self._readers if reader.statistics]
        spoken = [each for each in told if each.message_count]
        self.message_count = sum(each.message_count for each in told)
        self.start_ns = min((each.start_time for each in spoken), default=0)
        self.end_ns = max((each.end_time for each in spoken), default=0)

    def missing(self, path: Path) -> Words | None:
        """Return what is not there, and how the bag is made whole for other programs."""
        if not self._is_cut:
            return None
        return say(
            "{path} was cut short: the recording has not ended in order. {messages} messages are "
            "whole, the last {bytes} bytes are not; what was to come after is missing. "
            "`ros2 bag reindex` mends the index",
            path=path,
            messages=self.message_count,
            bytes=self._lost_bytes,
        )

    def messages(self, start_ns: int | None, wanted: Collection[Connection]) -> Iterator[Raw]:
        """Yield messages of these connections in the order of their times."""
        for reader in self._readers:
            own = [each for each in reader.connections if each in wanted]
            yield from in_order(reader.messages_scan(own, start_ns))

    def close(self) -> None:
        """Let go of the files."""
        self._stack.close()

    def _opened(self, path: Path) -> McapReader:
        reader = McapReader(path)
        with suppress(Exception):
            reader.open()
            self._stack.callback(reader.close)
            return reader
        self._is_cut = True
        reader = McapReader(path)
        reader.bio = self._stack.enter_context(path.open("rb"))
        reader.data_start, reader.data_end, size = whole_records(path)
        self._lost_bytes += size - reader.data_end
        reader.meta_scan()
        reader.connections = [
            each._replace(msgcount=reader.statistics.channel_message_counts.get(each.id, 0))
            for each in reader.connections
            if reader.statistics
        ]
        return reader


def whole_records(path: Path) -> tuple[int, int, int]:
    """Return where the records of an MCAP file begin, where the last whole one ends, its size.

    Raises ValueError for a file that is no MCAP at all.
    """
    size = path.stat().st_size
    with path.open("rb") as file:
        if file.read(len(MAGIC)) != MAGIC:
            raise ValueError(f"{path} does not begin as an MCAP file does")
        begin = end = len(MAGIC)
        while len(head := file.read(RECORD_HEAD.size)) == RECORD_HEAD.size:
            code, length = RECORD_HEAD.unpack(head)
            if code in {FOOTER, DATA_END} or end + RECORD_HEAD.size + length > size:
                break
            end = file.seek(length, 1)
    return begin, end, size


def in_order(messages: Iterator[Raw]) -> Iterator[Raw]:
    """Put messages that are nearly in order into order."""
    waiting: list[tuple[int, int, Raw]] = []
    for number, message in enumerate(messages):
        stamp_ns = message[1]
        heapq.heappush(waiting, (stamp_ns, number, message))
        while waiting[0][0] < stamp_ns - OUT_OF_ORDER_NS:
            yield heapq.heappop(waiting)[2]
    while waiting:
        yield heapq.heappop(waiting)[2]

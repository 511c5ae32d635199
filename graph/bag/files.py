"""The files of a bag, whole or cut short, behind one interface for reading them."""

from __future__ import annotations

import heapq
from collections import Counter
from collections.abc import Collection, Iterator
from contextlib import ExitStack, suppress
from typing import TYPE_CHECKING, Protocol

from graph.bag.mcap import Lost, TolerantMcap, TolerantReader, sound_parts
from text.sentences import Words, say

if TYPE_CHECKING:
    from pathlib import Path

    from rosbags.interfaces import Connection

OUT_OF_ORDER_NS = 3_000_000_000
"""How far out of order the messages of a cut bag may be: it was written topic by topic."""
Raw = tuple["Connection", int, bytes]


class BagReader(Protocol):
    """The interface of everything that reads a bag."""

    connections: list[Connection]
    start_ns: int
    end_ns: int
    message_count: int
    distro: str

    @property
    def lost(self) -> list[Lost]:
        """What has turned out to be damaged so far."""

    def messages(self, start_ns: int | None, wanted: Collection[Connection]) -> Iterator[Raw]:
        """Yield messages of these connections in the order of their times."""

    def close(self) -> None:
        """Let go of the files."""


class WholeBag:
    """A bag with an index, read by the library's reader."""

    def __init__(self, path: Path) -> None:
        """Open the bag. Raises what the library raises for a bag that it cannot read."""
        self._reader = TolerantReader(path)
        self._reader.open()
        self.connections = list(self._reader.connections)
        self.message_count = self._reader.message_count
        self.start_ns = self._reader.start_time if self.message_count else 0
        self.end_ns = self._reader.end_time - 1 if self.message_count else 0
        self.distro = self._reader.ros_distro or ""

    @property
    def lost(self) -> list[Lost]:
        """What has turned out to be damaged so far."""
        return self._reader.lost

    def messages(self, start_ns: int | None, wanted: Collection[Connection]) -> Iterator[Raw]:
        """Yield messages of these connections in the order of their times."""
        return self._reader.messages(wanted, start_ns) if wanted else iter(())

    def close(self) -> None:
        """Let go of the files."""
        self._reader.close()


class _CutFile:
    """One MCAP file without an end, scanned once."""

    def __init__(self, path: Path, stack: ExitStack) -> None:
        """Raises ValueError and what the library raises."""
        self._reader = reader = TolerantMcap(path)
        reader.bio = stack.enter_context(path.open("rb"))
        self._sound, self.lost, end, size = sound_parts(path)
        self.lost_bytes = size - end
        self.counts: Counter[int] = Counter()
        spans = []
        for reader.data_start, reader.data_end in self._sound:
            reader.meta_scan()
            assert reader.statistics is not None
            self.counts.update(reader.statistics.channel_message_counts)
            if reader.statistics.message_count:
                spans.append((reader.statistics.start_time, reader.statistics.end_time))
        self.start_ns = min((first for first, _last in spans), default=0)
        self.end_ns = max((last for _first, last in spans), default=0)
        self.connections = [
            each._replace(msgcount=self.counts[each.id]) for each in reader.connections
        ]
        nameless = self.counts.total() - sum(each.msgcount for each in self.connections)
        if nameless:
            # They were described in a chunk that is damaged.
            self.lost.append(Lost(self.start_ns, nameless))

    def messages(self, wanted: Collection[Connection], start_ns: int | None) -> Iterator[Raw]:
        reader = self._reader
        for reader.data_start, reader.data_end in self._sound:
            yield from reader.messages_scan(wanted, start_ns)


class CutFiles:
    """MCAP files, the last one cut short: read up to the last whole record."""

    distro = ""

    def __init__(self, paths: list[Path]) -> None:
        """Scan the files once. Raises ValueError and what the library raises."""
        self._stack = ExitStack()
        self._files: list[WholeBag | _CutFile] = []
        try:
            for path in paths:
                self._files.append(self._opened(path))
        except BaseException:
            self._stack.close()
            raise
        self.connections = [each for file in self._files for each in file.connections]
        self.message_count = sum(each.msgcount for each in self.connections)
        spoken = [file for file in self._files if file.end_ns]
        self.start_ns = min((each.start_ns for each in spoken), default=0)
        self.end_ns = max((each.end_ns for each in spoken), default=0)

    @property
    def lost(self) -> list[Lost]:
        """What has turned out to be damaged so far."""
        return [lost for file in self._files for lost in file.lost]

    def missing(self, path: Path) -> Words | None:
        """Return what is missing, and how to repair the bag for other programs."""
        cut = [file for file in self._files if isinstance(file, _CutFile)]
        if not cut:
            return None
        return say(
            "{path} was cut short: the recording was not ended properly. {messages} messages "
            "are intact, the last {bytes} bytes are damaged, and nothing follows them. "
            "`ros2 bag reindex` repairs the index",
            path=path,
            messages=self.message_count,
            bytes=sum(file.lost_bytes for file in cut),
        )

    def messages(self, start_ns: int | None, wanted: Collection[Connection]) -> Iterator[Raw]:
        """Yield messages of these connections in the order of their times."""
        for file in self._files:
            own = [each for each in file.connections if each in wanted]
            if isinstance(file, WholeBag):
                yield from file.messages(start_ns, own)
            else:
                yield from in_order(file.messages(own, start_ns))

    def close(self) -> None:
        """Let go of the files."""
        self._stack.close()

    def _opened(self, path: Path) -> WholeBag | _CutFile:
        with suppress(Exception):
            whole = WholeBag(path)
            self._stack.callback(whole.close)
            return whole
        return _CutFile(path, self._stack)


def in_order(messages: Iterator[Raw]) -> Iterator[Raw]:
    """Sort messages that are nearly in order."""
    waiting: list[tuple[int, int, Raw]] = []
    for number, message in enumerate(messages):
        stamp_ns = message[1]
        heapq.heappush(waiting, (stamp_ns, number, message))
        while waiting[0][0] < stamp_ns - OUT_OF_ORDER_NS:
            yield heapq.heappop(waiting)[2]
    while waiting:
        yield heapq.heappop(waiting)[2]

"""An MCAP file that may have damaged chunks: these are left out and counted, all others are read.

A chunk is taken whole or not at all: if one record in it is wrong, nothing vouches for those that
look right.
"""

from __future__ import annotations

import heapq
from collections import Counter
from operator import itemgetter
from typing import TYPE_CHECKING

from graph.bag.mcap_index import index_of
from graph.bag.mcap_records import CHUNK, RECORD_HEAD, Stretch, content_of, messages_in
from graph.bag.part import Found, Lost

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Sequence
    from contextlib import ExitStack
    from pathlib import Path

    from graph.bag.part import Channel

NOBODY = -1


class McapPart:
    """An open MCAP file."""

    distro = ""

    def __init__(self, file: Path, unpacked: Path, stack: ExitStack) -> None:
        """Read `unpacked`, which is called `file`; `stack` is closed with it.

        Raises ValueError and OSError.
        """
        self.file = file
        self._stack = stack
        self._bio = stack.enter_context(unpacked.open("rb"))
        index = index_of(self._bio, unpacked.stat().st_size)
        self._stretches = index.stretches
        self._lost = dict(enumerate(index.lost, start=-len(index.lost)))
        """Offset in the file to what is lost there."""
        counts: Counter[int] = Counter()
        for stretch in self._stretches:
            counts.update(stretch.counts)
        self.channels: Sequence[Channel] = [
            channel._replace(messages=counts[number]) for number, channel in sorted(index.described.channels.items())
        ]
        self.start_ns = min((stretch.first_ns for stretch in self._stretches), default=0)
        self.end_ns = max((stretch.last_ns for stretch in self._stretches), default=0)
        self.said = index.said
        self.cut_bytes = index.cut_bytes

    @property
    def lost(self) -> list[Lost]:
        """What has turned out to be damaged so far."""
        return list(self._lost.values())

    def messages(self, start_ns: int | None, numbers: Collection[int]) -> Iterator[Found]:
        """Yield messages of these channels in the order of their times."""
        wanted, begin_ns = frozenset(numbers), start_ns or 0
        stretches = (
            self._of(stretch)
            for stretch in self._stretches
            if stretch.last_ns >= begin_ns and not wanted.isdisjoint(stretch.counts)
        )
        for found in heapq.merge(*stretches, key=itemgetter(0)):
            if found[1] in wanted and found[0] >= begin_ns:
                yield found

    def close(self) -> None:
        """Let go of the file."""
        self._stack.close()

    def _of(self, stretch: Stretch) -> Iterator[Found]:
        # The merge takes one from each before it begins; not all should be read by then.
        yield stretch.first_ns, NOBODY, b""
        try:
            found = messages_in(self._content(stretch))
        except Exception:  # noqa: BLE001 - the disk, a decompressor, or the content
            found = []
        missing = sum(stretch.counts.values()) - len(found)
        if missing > 0:
            self._lost[stretch.offset] = Lost(stretch.first_ns, missing)
        found.sort(key=itemgetter(0))
        yield from found

    def _content(self, stretch: Stretch) -> bytes:
        self._bio.seek(stretch.offset)
        raw = self._bio.read(stretch.length)
        if not stretch.is_chunk:
            return raw
        if RECORD_HEAD.unpack_from(raw) != (CHUNK, stretch.length - RECORD_HEAD.size):
            raise ValueError("there is no chunk where one should be")
        return content_of(raw[RECORD_HEAD.size :])

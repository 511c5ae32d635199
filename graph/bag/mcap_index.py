"""Where the messages of an MCAP file are: by its own summary, or by reading all of it.

A summary is taken only if it accounts for every message that the file says it holds.
"""

from __future__ import annotations

from binascii import crc32
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, BinaryIO

from graph.bag.kinds import MCAP_MAGIC
from graph.bag.mcap_records import (
    CHANNEL,
    CHUNK,
    CHUNK_INDEX,
    DATA_END,
    FOOTER,
    FOOTER_BODY,
    INDEX_ENTRY,
    INDEX_HEAD,
    MESSAGE,
    MESSAGE_HEAD,
    MESSAGE_INDEX,
    RECORD_HEAD,
    SCHEMA,
    STATISTICS,
    Described,
    Statistics,
    Stretch,
    chunk_index,
    content_of,
    is_known,
    messages_in,
    records,
    statistics,
)
from graph.bag.part import Lost

if TYPE_CHECKING:
    pass

FOOTER_LENGTH = RECORD_HEAD.size + FOOTER_BODY.size
CHECKSUM_LENGTH = 4
LONGEST_LOOSE = 4_000_000
"""Bytes of messages outside of chunks that are read at once."""


@dataclass
class Index:
    """Where the messages of a file are."""

    described: Described = field(default_factory=Described)
    stretches: list[Stretch] = field(default_factory=list)
    lost: list[Lost] = field(default_factory=list)
    said: int | None = None
    """How many messages the file holds by its own statistics."""
    cut_bytes: int | None = None
    """How much follows the last whole record of a file without an end, None for a whole file."""


def index_of(file: BinaryIO, size: int) -> Index:
    """Return the index of an open file. Raises ValueError for a file that is not MCAP at all."""
    file.seek(0)
    if file.read(len(MCAP_MAGIC)) != MCAP_MAGIC:
        raise ValueError("it does not begin as an MCAP file does")
    by_summary, counted = _by_summary(file, size)
    if by_summary is not None:
        return by_summary
    scanned = _Scan(file, size).index()
    scanned.said = counted.messages if counted is not None else None
    return scanned


def counted_in_summary(file: BinaryIO, size: int) -> int | None:
    """Return how many messages an open file holds by its statistics, None if it has none."""
    _index, counted = _by_summary(file, size)
    return None if counted is None else counted.messages


def _by_summary(file: BinaryIO, size: int) -> tuple[Index | None, Statistics | None]:
    """Return the index if the summary is complete, and the statistics if there are any."""
    index, counted, chunks = Index(), None, []
    try:
        summary = _summary(file, size)
        for code, begin, end in records(summary):
            body = summary[begin:end]
            if code == STATISTICS:
                counted = statistics(body)
            elif code == CHUNK_INDEX:
                chunks.append(chunk_index(body))
            else:
                index.described.take(code, body)
    except Exception:  # noqa: BLE001 - whatever is wrong with it, the file itself is asked
        return None, None
    if counted is None or counted.chunks != len(chunks):
        return None, counted
    in_chunks = sum(sum(chunk.counts.values()) for chunk in chunks)
    numbers = {number for chunk in chunks for number in chunk.counts}
    if in_chunks != counted.messages or numbers - index.described.channels.keys():
        return None, counted
    index.stretches = [chunk for chunk in chunks if chunk.counts]
    index.said = counted.messages
    return index, counted


def _summary(file: BinaryIO, size: int) -> bytes:
    """Return the records of the summary, empty if there is none. Raises ValueError."""
    begin = size - FOOTER_LENGTH - len(MCAP_MAGIC)
    file.seek(max(0, begin))
    end = file.read()
    if begin < 0 or not end.endswith(MCAP_MAGIC):
        raise ValueError("there is no end")
    if RECORD_HEAD.unpack_from(end) != (FOOTER, FOOTER_BODY.size):
        raise ValueError("there is no footer")
    at, _offsets, checksum = FOOTER_BODY.unpack_from(end, RECORD_HEAD.size)
    if not at:
        return b""
    file.seek(at)
    summary = file.read(max(0, begin - at))
    checked = summary + end[: FOOTER_LENGTH - CHECKSUM_LENGTH]
    if checksum and crc32(checked) != checksum:
        raise ValueError("the summary is damaged")
    return summary


class _Scan:
    """Reads a file record by record."""

    def __init__(self, file: BinaryIO, size: int) -> None:
        self._file = file
        self._size = size
        self._index = Index()
        self._loose = _Loose()
        self._last_ns = 0
        self._follows_damage = False

    def index(self) -> Index:
        """Return where everything is that can be read."""
        at, is_whole = self._walk()
        self._end_loose()
        index = self._index
        if not is_whole:
            index.cut_bytes = self._size - at
        nameless = sum(
            count
            for stretch in index.stretches
            for number, count in stretch.counts.items()
            if number not in index.described.channels
        )
        if nameless:
            # They were described in a chunk that is damaged.
            first_ns = min(stretch.first_ns for stretch in index.stretches)
            index.lost.append(Lost(first_ns, nameless))
        return index

    def _walk(self) -> tuple[int, bool]:
        """Take all records; return the place behind the last, and whether the data ends there."""
        file = self._file
        at = file.seek(len(MCAP_MAGIC))
        while len(head := file.read(RECORD_HEAD.size)) == RECORD_HEAD.size:
            code, length = RECORD_HEAD.unpack(head)
            behind = at + RECORD_HEAD.size + length
            if code in {FOOTER, DATA_END} and behind <= self._size:
                return at, True
            if behind > self._size or not is_known(code):
                break
            try:
                self._take(code, at, length)
            except Exception:  # noqa: BLE001 - the disk, a decompressor, or the content
                self._damaged()
            at = file.seek(behind)
        return at, False

    def _take(self, code: int, at: int, length: int) -> None:
        if code == CHUNK:
            self._take_chunk(at, length)
        elif code == MESSAGE:
            self._take_message(at, length)
        elif code in {SCHEMA, CHANNEL}:
            self._index.described.take(code, self._file.read(length))
        elif code == MESSAGE_INDEX and self._follows_damage:
            count = max(0, length - INDEX_HEAD) // INDEX_ENTRY
            lost = self._index.lost
            lost[-1] = lost[-1]._replace(messages=lost[-1].messages + count)

    def _take_chunk(self, at: int, length: int) -> None:
        self._end_loose()
        content = content_of(self._file.read(length))
        found = messages_in(content)
        self._follows_damage = False
        for code, begin, end in records(content):
            self._index.described.take(code, content[begin:end])
        if not found:
            return
        stamps = [stamp_ns for stamp_ns, _number, _raw in found]
        self._last_ns = max(stamps)
        counts = Counter(number for _stamp_ns, number, _raw in found)
        stretch = Stretch(at, RECORD_HEAD.size + length, min(stamps), self._last_ns, counts)
        self._index.stretches.append(stretch)

    def _take_message(self, at: int, length: int) -> None:
        number, _sequence, stamp_ns, _sent_ns = MESSAGE_HEAD.unpack(
            self._file.read(MESSAGE_HEAD.size)
        )
        if length < MESSAGE_HEAD.size:
            raise ValueError("a message is too short")
        if not self._loose.adjoins(at):
            self._end_loose()
        self._loose.take(at, RECORD_HEAD.size + length, number, stamp_ns)
        self._last_ns = max(self._last_ns, stamp_ns)

    def _end_loose(self) -> None:
        self._index.stretches += self._loose.ended()

    def _damaged(self) -> None:
        self._follows_damage = True
        self._index.lost.append(Lost(self._last_ns, 0))


class _Loose:
    """Messages outside of chunks, which are read some together."""

    def __init__(self) -> None:
        self._stretch: Stretch | None = None
        self._numbers: list[int] = []

    def adjoins(self, at: int) -> bool:
        stretch = self._stretch
        return stretch is None or (
            stretch.offset + stretch.length == at and stretch.length < LONGEST_LOOSE
        )

    def take(self, at: int, length: int, number: int, stamp_ns: int) -> None:
        before = self._stretch or Stretch(at, 0, stamp_ns, stamp_ns, {}, is_chunk=False)
        self._numbers.append(number)
        self._stretch = before._replace(
            length=before.length + length,
            first_ns=min(before.first_ns, stamp_ns),
            last_ns=max(before.last_ns, stamp_ns),
        )

    def ended(self) -> list[Stretch]:
        stretch, numbers = self._stretch, self._numbers
        self._stretch, self._numbers = None, []
        return [] if stretch is None else [stretch._replace(counts=Counter(numbers))]

"""Where the messages of an MCAP file are: by its own summary, or by reading all of it.

A summary is taken only if it accounts for every message that the file says it holds.
"""

from __future__ import annotations

from binascii import crc32
from collections import Counter
from dataclasses import dataclass, field
from typing import BinaryIO

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
    summary = _summary_of(file, size)
    return _by_summary(summary) or _Scan(file, size, summary).index()


def counted_in_summary(file: BinaryIO, size: int) -> int | None:
    """Return how many messages an open file holds by its statistics, None if it has none."""
    counted = _summary_of(file, size).counted
    return None if counted is None else counted.messages


@dataclass
class _Summary:
    """What a file says of itself at its end."""

    ended: bool = False
    """Whether the file has an end, so that it was not cut short."""
    described: Described = field(default_factory=Described)
    counted: Statistics | None = None
    chunks: list[Stretch] = field(default_factory=list)

    @property
    def in_chunks(self) -> int:
        """How many messages the indexes of its chunks count."""
        return sum(sum(chunk.counts.values()) for chunk in self.chunks)

    @property
    def said(self) -> int | None:
        """How many messages the file holds at least, None if it does not say."""
        return self.in_chunks or None if self.counted is None else self.counted.messages


def _by_summary(summary: _Summary) -> Index | None:
    counted, chunks = summary.counted, summary.chunks
    if counted is None or counted.chunks != len(chunks):
        return None
    numbers = {number for chunk in chunks for number in chunk.counts}
    if summary.in_chunks != counted.messages or numbers - summary.described.channels.keys():
        return None
    stretches = [chunk for chunk in chunks if chunk.counts]
    return Index(summary.described, stretches, said=counted.messages)


def _summary_of(file: BinaryIO, size: int) -> _Summary:
    """Return what the summary says; nothing of one that is damaged: the file itself is asked."""
    summary = _Summary()
    try:
        raw = _records_of_summary(file, size)
        summary.ended = True
        for code, begin, end in records(raw):
            body = raw[begin:end]
            if code == STATISTICS:
                summary.counted = statistics(body)
            elif code == CHUNK_INDEX:
                summary.chunks.append(chunk_index(body))
            else:
                summary.described.take(code, body)
    except Exception:  # noqa: BLE001 - whatever is wrong with it
        return _Summary(summary.ended)
    return summary


def _records_of_summary(file: BinaryIO, size: int) -> bytes:
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
    """Reads a file record by record; of its summary it takes what stands in damaged places, too."""

    def __init__(self, file: BinaryIO, size: int, summary: _Summary) -> None:
        self._file = file
        self._size = size
        self._ended = summary.ended
        self._chunks = sorted(chunk.offset for chunk in summary.chunks)
        self._at_chunk = 0
        self._index = Index(summary.described, said=summary.said)
        self._loose = _Loose()
        self._last_ns = 0
        self._follows_damage = False

    def index(self) -> Index:
        """Return where everything is that can be read."""
        at, is_whole = self._walk()
        self._end_loose()
        index = self._index
        if not is_whole and not self._ended:
            index.cut_bytes = self._size - at
        elif not is_whole:
            self._broken()
        self._count_lost()
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

    def _count_lost(self) -> None:
        """Take what the file counts and nobody has found for what the damaged places held."""
        index = self._index
        unknown = [place for place, lost in enumerate(index.lost) if lost.messages is None]
        if index.said is None or not unknown:
            return
        found = sum(sum(stretch.counts.values()) for stretch in index.stretches)
        missing = index.said - found - sum(lost.messages or 0 for lost in index.lost)
        for place in unknown:
            index.lost[place] = index.lost[place]._replace(messages=max(0, missing))
            missing = 0

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
                behind = self._chunk_behind(at)
                if not behind:
                    break
                self._broken()
            else:
                try:
                    self._take(code, at, length)
                except Exception:  # noqa: BLE001 - the disk, a decompressor, or the content
                    self._damaged()
            at = file.seek(behind)
        return at, False

    def _chunk_behind(self, at: int) -> int:
        """Return where, by the summary, the reading can go on behind a broken record, else 0."""
        behind = (place for place in self._chunks if place > self._at_chunk and place != at)
        self._at_chunk = next(behind, 0)
        return self._at_chunk

    def _take(self, code: int, at: int, length: int) -> None:
        if code == CHUNK:
            self._at_chunk = at
            self._take_chunk(at, length)
        elif code == MESSAGE:
            self._take_message(at, length)
        elif code in {SCHEMA, CHANNEL}:
            self._index.described.take(code, self._file.read(length))
        elif code == MESSAGE_INDEX and self._follows_damage:
            count = max(0, length - INDEX_HEAD) // INDEX_ENTRY
            lost = self._index.lost
            lost[-1] = lost[-1]._replace(messages=(lost[-1].messages or 0) + count)

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
        number, _sequence, stamp_ns, _sent_ns = MESSAGE_HEAD.unpack(self._file.read(MESSAGE_HEAD.size))
        if length < MESSAGE_HEAD.size:
            raise ValueError("a message is too short")
        if not self._loose.adjoins(at):
            self._end_loose()
        self._loose.take(at, RECORD_HEAD.size + length, number, stamp_ns)
        self._last_ns = max(self._last_ns, stamp_ns)

    def _end_loose(self) -> None:
        self._index.stretches += self._loose.ended()

    def _broken(self) -> None:
        """Note that it is not known where the next record is, if that is no part of a damage."""
        if not self._follows_damage or self._index.lost[-1].messages is not None:
            self._damaged()

    def _damaged(self) -> None:
        self._follows_damage = True
        self._index.lost.append(Lost(self._last_ns, None))


class _Loose:
    """Messages outside of chunks, which are read some together."""

    def __init__(self) -> None:
        self._stretch: Stretch | None = None
        self._numbers: list[int] = []

    def adjoins(self, at: int) -> bool:
        stretch = self._stretch
        return stretch is None or (stretch.offset + stretch.length == at and stretch.length < LONGEST_LOOSE)

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

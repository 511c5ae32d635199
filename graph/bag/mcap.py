"""MCAP files that may have damaged chunks: these are left out and counted, all others are read.

Format: https://mcap.dev/spec. A chunk is taken whole or not at all: if one record in it is
wrong, nothing vouches for those that look right.
"""

from __future__ import annotations

import heapq
import struct
from operator import itemgetter
from typing import TYPE_CHECKING, NamedTuple

from rosbags.rosbag2 import Reader
from rosbags.rosbag2.reader import DirectoryReader
from rosbags.rosbag2.storage_mcap import MAXSIZE, McapReader, decompress

if TYPE_CHECKING:
    from collections.abc import Collection, Generator, Iterator, Mapping
    from pathlib import Path

    from rosbags.interfaces import Connection
    from rosbags.rosbag2.reader import ReaderProtocol
    from rosbags.rosbag2.storage_mcap import ChunkInfo

MAGIC = b"\x89MCAP0\r\n"
FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, DATA_END = 2, 3, 4, 5, 6, 7, 15
IN_CHUNK = frozenset({SCHEMA, CHANNEL, MESSAGE})
PRIVATE = 0x80
"""Opcodes from here on are free for private use."""
RECORD_HEAD = struct.Struct("<BQ")
CHUNK_HEAD = struct.Struct("<QQQII")
"""First and last time, size, checksum, and length of the name of the compression."""
SIZE = struct.Struct("<Q")
MESSAGE_HEAD = struct.Struct("<HIQQ")
INDEX_HEAD = 6
INDEX_ENTRY = 16
NOBODY = -1
Found = tuple[int, int, bytes]
"""Unix time in nanoseconds, number of the channel, raw message."""


class Lost(NamedTuple):
    """A chunk that cannot be read."""

    at_ns: int
    """Unix time of its first message, if known."""
    messages: int
    """How many messages it held, if known."""


class Parts(NamedTuple):
    """The intact parts of a file without an index."""

    sound: list[tuple[int, int]]
    """Readable stretches of the file: first offset, and the offset after the last record."""
    lost: list[Lost]
    end: int
    """The offset after the last whole record."""
    size: int


class TolerantMcap(McapReader):
    """The library's reader, except that a damaged chunk costs no more than that chunk."""

    def __init__(self, path: Path) -> None:
        """Read this file once it is opened."""
        super().__init__(path)
        self.lost: dict[int, Lost] = {}
        """Offset in the file to what is lost there; grows while messages are read."""

    def messages(
        self, connections: Collection[Connection], start: int | None = None, stop: int | None = None
    ) -> Generator[tuple[Connection, int, bytes], None, None]:
        """Yield messages of these connections in the order of their times."""
        if not self.chunks:
            yield from super().messages(connections, start, stop)
            return
        wanted = {each.id: each for each in connections}
        begin_ns, end_ns = start or 0, MAXSIZE if stop is None else stop
        chunks = (
            self._of_chunk(chunk)
            for chunk in self.chunks
            if chunk.message_end_time >= begin_ns and chunk.message_start_time < end_ns
            if any(chunk.channel_count.get(number) for number in wanted)
        )
        for stamp_ns, number, raw in heapq.merge(*chunks, key=itemgetter(0)):
            if number in wanted and begin_ns <= stamp_ns < end_ns:
                yield wanted[number], stamp_ns, raw

    def _of_chunk(self, chunk: ChunkInfo) -> Iterator[Found]:
        # The merge takes one from each before it begins; not all chunks should be read by then.
        yield chunk.message_start_time, NOBODY, b""
        try:
            found = messages_in(self._record(chunk))
        except Exception:  # noqa: BLE001 - the disk, a decompressor, or the content
            messages = sum(chunk.channel_count.values())
            self.lost[chunk.chunk_start_offset] = Lost(chunk.message_start_time, messages)
            return
        found.sort(key=itemgetter(0))
        yield from found

    def _record(self, chunk: ChunkInfo) -> bytes:
        """Return the content of a chunk's record."""
        assert self.bio is not None
        self.bio.seek(chunk.chunk_start_offset)
        raw = self.bio.read(chunk.chunk_length)
        if RECORD_HEAD.unpack_from(raw) != (CHUNK, chunk.chunk_length - RECORD_HEAD.size):
            raise ValueError("there is no chunk where one should be")
        return raw[RECORD_HEAD.size :]


class _TolerantDirectory(DirectoryReader):
    STORAGE_PLUGINS: Mapping[str, type[ReaderProtocol]] = {
        **DirectoryReader.STORAGE_PLUGINS,
        "mcap": TolerantMcap,
    }


class TolerantReader(Reader):
    """The library's reader for bags of all kinds, with `TolerantMcap` for MCAP."""

    STORAGE_PLUGINS: Mapping[str, type[ReaderProtocol]] = {
        **Reader.STORAGE_PLUGINS,
        "dir": _TolerantDirectory,
        ".mcap": TolerantMcap,
    }

    @property
    def lost(self) -> list[Lost]:
        """What could not be read so far."""
        storage = self.storage
        parts = storage.storages if isinstance(storage, DirectoryReader) else [storage]
        return [
            lost for one in parts if isinstance(one, TolerantMcap) for lost in one.lost.values()
        ]


def messages_in(record: bytes) -> list[Found]:
    """Return the messages in the content of a chunk's record.

    Raises any exception if a single byte of its framing is wrong, or its checksum.
    """
    first_ns, last_ns, size, checksum, named = CHUNK_HEAD.unpack_from(record)
    at = CHUNK_HEAD.size + named
    compression = record[CHUNK_HEAD.size : at].decode()
    (packed,) = SIZE.unpack_from(record, at)
    at += SIZE.size
    if at + packed != len(record):
        raise ValueError("a chunk and what is in it differ in length")
    raw = decompress(record[at:], compression, size, checksum)
    found: list[Found] = []
    place = 0
    while place < len(raw):
        code, length = RECORD_HEAD.unpack_from(raw, place)
        begin = place + RECORD_HEAD.size
        place = begin + length
        if code not in IN_CHUNK or place > len(raw):
            raise ValueError("there is no record where one should be")
        if code == MESSAGE:
            number, _sequence, stamp_ns, _sent_ns = MESSAGE_HEAD.unpack_from(raw, begin)
            if not first_ns <= stamp_ns <= last_ns:
                raise ValueError("a message is of another time than its chunk")
            found.append((stamp_ns, number, raw[begin + MESSAGE_HEAD.size : place]))
    return found


def sound_parts(path: Path) -> Parts:
    """Scan a file record by record without using its index.

    Raises ValueError for a file that is not MCAP at all, and OSError.
    """
    size = path.stat().st_size
    sound: list[tuple[int, int]] = []
    lost: list[Lost] = []
    last_ns = 0
    follows_damage = False
    with path.open("rb") as file:
        if file.read(len(MAGIC)) != MAGIC:
            raise ValueError(f"{path} does not begin as an MCAP file does")
        begin = end = len(MAGIC)
        while len(head := file.read(RECORD_HEAD.size)) == RECORD_HEAD.size:
            code, length = RECORD_HEAD.unpack(head)
            behind = end + RECORD_HEAD.size + length
            if code in {FOOTER, DATA_END} or behind > size or not _is_known(code):
                break
            if code == CHUNK:
                try:
                    found = messages_in(file.read(length))
                except Exception:  # noqa: BLE001 - as above
                    follows_damage = True
                    lost.append(Lost(last_ns, 0))
                    sound.append((begin, end))
                    begin = behind
                else:
                    follows_damage = False
                    last_ns = max((stamp_ns for stamp_ns, *_rest in found), default=last_ns)
            elif code == MESSAGE_INDEX and follows_damage:
                count = max(0, length - INDEX_HEAD) // INDEX_ENTRY
                lost[-1] = lost[-1]._replace(messages=lost[-1].messages + count)
            end = file.seek(behind)
    sound.append((begin, end))
    return Parts([part for part in sound if part[0] < part[1]], lost, end, size)


def _is_known(code: int) -> bool:
    return 0 < code <= DATA_END or code >= PRIVATE

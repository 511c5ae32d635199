"""The files of a bag: MCAP read chunk by chunk with the library `mcap`, SQLite with `rosbags`.

An MCAP chunk with a single wrong byte is left out and counted, all others are read. A damaged SQLite file is refused.
"""

from __future__ import annotations

import heapq
import struct
import sys
from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from contextlib import ExitStack
from io import BytesIO
from operator import itemgetter
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, BinaryIO, NamedTuple, TypeAlias
from urllib.parse import quote

from graph.bag import files
from graph.bag.errors import BagError, unreadable
from graph.messages.definitions import TypeText
from text.sentences import say

if sys.version_info >= (3, 14):
    from compression import zstd
else:
    from backports import zstd

if TYPE_CHECKING:
    from mcap.records import Channel as ChannelRecord
    from mcap.records import ChunkIndex, Schema
    from mcap.summary import Summary
    from rosbags.interfaces import Connection

CDR = "cdr"
Found: TypeAlias = "tuple[int, int, bytes]"
"""Unix time in nanoseconds, number of the channel, raw message."""
ROS2_SCHEMAS = {"ros2msg": False, "ros2idl": True, "omgidl": True, "": False}
"""Encoding of a schema that ROS 2 writes, to whether it is IDL."""
SCHEMA, CHANNEL, MESSAGE, CHUNK, DATA_END = 3, 4, 5, 6, 15
"""Codes of records of MCAP (source: https://mcap.dev/spec)."""
FOOTER, PRIVATE = 2, 0x80
"""Codes from `PRIVATE` on are free for private use."""
HEAD = struct.Struct("<BQ")
MESSAGE_HEAD = struct.Struct("<HIQQ")
INDEX_HEAD, INDEX_ENTRY = HEAD.size + 6, 16
"""Bytes of a message index: of one channel in a chunk, and of each of its messages."""
LONGEST_LOOSE = 4_000_000
"""Bytes of messages outside of chunks that are read at once."""
NOBODY = -1
STEP_BYTES = 65_536


class Channel(NamedTuple):
    """One topic of one file, of one type."""

    number: int
    topic: str
    kind: TypeText
    messages: int = 0
    encoding: str = CDR
    """How its messages are written. Only ROS 2's own, CDR, can be decoded and published."""
    offer: files.Offer = files.Offer()
    """QoS offered by its first publisher."""


class Lost(NamedTuple):
    """A place of a file that cannot be read."""

    at_ns: int
    """Unix time of its first message, or of the last one before it."""
    messages: int | None
    """How many messages it held, None if that is not known."""


class Stretch(NamedTuple):
    """A chunk, or messages outside of chunks that follow one another."""

    offset: int
    length: int
    first_ns: int
    last_ns: int
    channels: Collection[int]
    messages: int
    is_chunk: bool = True


def opened(file: Path) -> BagPart:
    """Open a file of a bag, by what is in it. Raises BagError that says why it cannot be read."""
    with ExitStack() as stack:
        try:
            part = _opened(file, stack)
        except BagError:
            raise
        except Exception as error:
            raise unreadable(file, error) from error
        part.stack = stack.pop_all()
    return part


def _opened(file: Path, stack: ExitStack) -> BagPart:
    content = file
    if files.storage_of(file) == files.ZSTD:
        content = Path(stack.enter_context(TemporaryDirectory(prefix="deck-bag-")), file.stem)
        _unpack(file, content)
    if (defect := files.defect_of(content)) is not None:
        raise BagError(defect)
    kind = SqlitePart if files.storage_of(content) == files.SQLITE else McapPart
    return kind(file, content, stack)


def _unpack(file: Path, target: Path) -> None:
    """Unpack a file that rosbag2 has packed as a whole, one that is cut short as far as it goes."""
    with zstd.open(file, "rb") as packed, target.open("wb") as plain:
        try:
            # Not `read`, which keeps nothing of what it has when it comes to the cut.
            while step := packed.read1(STEP_BYTES):
                plain.write(step)
        except (EOFError, zstd.ZstdError):
            if not plain.tell():
                raise


def unpacked(message: bytes) -> bytes | None:
    """Return a message as it was before rosbag2 packed it; None if it is damaged.

    CDR begins with 0, so that a packed message is never taken for a plain one, whatever metadata.yaml says.
    """
    if not message.startswith(files.ZSTD_MAGIC):
        return message
    try:
        return bytes(zstd.decompress(message))
    except zstd.ZstdError:
        return None


class SqlitePart:
    """An open SQLite file, of any version of rosbag2; it counts its messages by looking at each."""

    stack: ExitStack
    said: int | None = None
    cut_bytes: int | None = None
    lost: Sequence[Lost] = ()

    def __init__(self, file: Path, content: Path, stack: ExitStack) -> None:
        """Read `content`, which is called `file`. Raises BagError and what the library raises."""
        from rosbags.rosbag2.storage_sqlite3 import Sqlite3Reader

        self.file = file
        if beside := files.beside_database(content):
            raise BagError(
                say(
                    "{file}: a part of it is still in {beside}: it is being written, or was not closed; "
                    "`sqlite3 {file} .tables` completes it",
                    file=file.name,
                    beside=beside,
                )
            )
        # The library puts the path into a URI as it is.
        self._reader = Sqlite3Reader(Path(quote(str(content.absolute()))))
        try:
            self._reader.open()
        except Exception as error:
            raise _refused_database(file, error) from error
        stack.callback(self._reader.close)
        self.channels = [_channel_of_table(connection) for connection in self._reader.connections]
        facts = self._reader.metadata
        self.start_ns = facts.start_time if facts.message_count else 0
        self.end_ns = facts.end_time - 1 if facts.message_count else 0

    def messages(self, start_ns: int | None, numbers: Collection[int]) -> Iterator[Found]:
        """Yield messages of these channels in the order of their times. Raises BagError where it is damaged."""
        wanted = [connection for connection in self._reader.connections if connection.id in numbers]
        try:
            for connection, stamp_ns, raw in self._reader.messages(wanted, start_ns):
                yield stamp_ns, connection.id, raw
        except Exception as error:
            raise _refused_database(self.file, error) from error


def _refused_database(file: Path, error: Exception) -> BagError:
    from rosbags.rosbag2 import ReaderError

    reason = error.__cause__ if isinstance(error, ReaderError) else error
    if reason is None:
        return BagError(say("{file} is a database, but not of a recording", file=file.name))
    words = say(
        "{file} is damaged ({reason}); `sqlite3 {file} .recover | sqlite3 new.db3` saves what can be read of it",
        file=file.name,
        reason=reason,
    )
    return BagError(words)


def _channel_of_table(connection: Connection) -> Channel:
    from rosbags.interfaces import ConnectionExtRosbag2, MessageDefinitionFormat

    text, ext = connection.msgdef, connection.ext
    assert isinstance(ext, ConnectionExtRosbag2)
    kind = TypeText(connection.msgtype, text.data, text.format == MessageDefinitionFormat.IDL)
    offers = [{"reliability": o.reliability.name, "durability": o.durability.name} for o in ext.offered_qos_profiles]
    offer = files.offer_in(offers)
    encoding = ext.serialization_format or CDR
    return Channel(connection.id, connection.topic, kind, connection.msgcount, encoding, offer)


class McapPart:
    """An open MCAP file. Its summary is taken only if it accounts for every message; else all of it is read once."""

    stack: ExitStack

    def __init__(self, file: Path, content: Path, stack: ExitStack) -> None:
        """Read `content`, which is called `file`. Raises ValueError and OSError."""
        self.file = file
        self.said: int | None = None
        """How many messages it holds by its own count, None if it keeps none."""
        self.cut_bytes: int | None = None
        """Length of what cannot be read at the end of a file without an end; None for a whole one."""
        self._lost: dict[int, Lost] = {}
        """Offset in the file to what is lost there."""
        self._stream = stack.enter_context(content.open("rb"))
        self._schemas: dict[int, Schema] = {}
        self._channels: dict[int, ChannelRecord] = {}
        self._counts: Counter[int] = Counter()
        self._stretches: list[Stretch] = []
        summary = summary_of(self._stream)
        if summary is not None:
            self._schemas, self._channels = summary.schemas, summary.channels
            self.said = summary.statistics.message_count if summary.statistics else None
        if summary is None or not self._take_summary(summary):
            self._scan(content.stat().st_size)
        self.channels: Sequence[Channel] = [
            _channel_of_mcap(channel, self._schemas.get(channel.schema_id), self._counts[number])
            for number, channel in sorted(self._channels.items())
        ]
        self.start_ns = min((stretch.first_ns for stretch in self._stretches), default=0)
        """Unix time of the first message, 0 if there is none."""
        self.end_ns = max((stretch.last_ns for stretch in self._stretches), default=0)

    @property
    def lost(self) -> Sequence[Lost]:
        """What has turned out to be damaged so far; grows while messages are read."""
        return list(self._lost.values())

    def messages(self, start_ns: int | None, numbers: Collection[int]) -> Iterator[Found]:
        """Yield messages of these channels in the order of their times."""
        wanted, begin_ns = frozenset(numbers), start_ns or 0
        stretches = (
            self._of(stretch)
            for stretch in self._stretches
            if stretch.last_ns >= begin_ns and not wanted.isdisjoint(stretch.channels)
        )
        for found in heapq.merge(*stretches, key=itemgetter(0)):
            if found[1] in wanted and found[0] >= begin_ns:
                yield found

    def _of(self, stretch: Stretch) -> Iterator[Found]:
        # The merge takes one from each before it begins; not all should be read by then.
        yield stretch.first_ns, NOBODY, b""
        try:
            self._stream.seek(stretch.offset)
            raw = self._stream.read(stretch.length)
            found, _described = _split(_content(raw) if stretch.is_chunk else raw)
        except Exception:  # noqa: BLE001 - the disk, a decompressor, or the content
            self._lost.setdefault(stretch.offset, Lost(stretch.first_ns, stretch.messages))
            return
        found.sort(key=itemgetter(0))
        yield from found

    def _take_summary(self, summary: Summary) -> bool:
        """Take what the summary says, unless it does not account for every message."""
        said = summary.statistics
        stretches = [_indexed(chunk) for chunk in summary.chunk_indexes]
        held = sum(stretch.messages for stretch in stretches)
        if said is None or said.chunk_count != len(stretches) or said.message_count != held:
            return False
        self._counts.update(said.channel_message_counts)
        self._stretches = [stretch for stretch in stretches if stretch.messages]
        return self._counts.total() == held and self._counts.keys() <= summary.channels.keys()

    def _scan(self, size: int) -> None:
        """Read the file record by record, up to its end or to where it is cut or broken."""
        self._counts.clear()
        self._stretches, last_ns, behind = [], 0, len(files.MCAP_MAGIC)
        while True:
            at = self._stream.seek(behind)
            head = self._stream.read(HEAD.size)
            code, length = HEAD.unpack(head) if len(head) == HEAD.size else (0, 0)
            behind = at + HEAD.size + length
            if behind > size or not (0 < code <= DATA_END or code >= PRIVATE) or code in {FOOTER, DATA_END}:
                break
            try:
                self._take(code, at, length)
            except Exception:  # noqa: BLE001 - the disk, a decompressor, or the content
                self._lost[at] = Lost(last_ns, None)
            last_ns = max(last_ns, self._stretches[-1].last_ns if self._stretches else 0)
        if files.has_end(self._stream):
            if code not in {FOOTER, DATA_END}:
                self._lost[at] = Lost(last_ns, None)
        else:
            self.cut_bytes = size - at
        if self._lost and self.said is not None:
            # What the file counts and nobody has found is what the damaged places held.
            first = min(self._lost)
            missing = max(0, self.said - self._counts.total())
            self._lost = {place: lost._replace(messages=0) for place, lost in self._lost.items()}
            self._lost[first] = self._lost[first]._replace(messages=missing)

    def _take(self, code: int, at: int, length: int) -> None:
        if code in {SCHEMA, CHANNEL}:
            self._describe(code, self._stream.read(length))
        elif code == CHUNK:
            body = self._stream.read(length)
            found, described = _split(_content(body))
            for each in described:
                self._describe(*each)
            if found:
                counts = Counter(number for _stamp_ns, number, _raw in found)
                stamps = [stamp_ns for stamp_ns, _number, _raw in found]
                self._counts.update(counts)
                self._stretches.append(
                    Stretch(at + HEAD.size, length, min(stamps), max(stamps), counts.keys(), len(found))
                )
        elif code == MESSAGE:
            number, _sequence, stamp_ns, _sent_ns = MESSAGE_HEAD.unpack(self._stream.read(MESSAGE_HEAD.size))
            self._counts[number] += 1
            self._take_loose(at, HEAD.size + length, number, stamp_ns)

    def _take_loose(self, at: int, length: int, number: int, stamp_ns: int) -> None:
        """Add a message outside of chunks to the stretch before it, or begin another."""
        last = self._stretches[-1] if self._stretches else None
        if last is None or last.is_chunk or last.offset + last.length != at or last.length > LONGEST_LOOSE:
            self._stretches.append(Stretch(at, length, stamp_ns, stamp_ns, {number}, 1, is_chunk=False))
        else:
            self._stretches[-1] = last._replace(
                length=last.length + length,
                first_ns=min(last.first_ns, stamp_ns),
                last_ns=max(last.last_ns, stamp_ns),
                channels={*last.channels, number},
                messages=last.messages + 1,
            )

    def _describe(self, code: int, body: bytes) -> None:
        """Take the record of a schema or a channel."""
        from mcap import records
        from mcap.data_stream import ReadDataStream

        stream = ReadDataStream(BytesIO(body))
        if code == SCHEMA:
            schema = records.Schema.read(stream)
            self._schemas[schema.id] = schema
        else:
            channel = records.Channel.read(stream)
            self._channels[channel.id] = channel


BagPart: TypeAlias = "McapPart | SqlitePart"


def summary_of(stream: BinaryIO) -> Summary | None:
    """Return what an MCAP file says of itself at its end, None if nothing or if that is damaged."""
    from mcap.reader import SeekingReader

    try:
        return SeekingReader(stream).get_summary()
    except Exception:  # noqa: BLE001 - whatever is wrong with it, the file itself tells
        return None


def _indexed(chunk: ChunkIndex) -> Stretch:
    indexes = chunk.message_index_offsets.keys()
    return Stretch(
        chunk.chunk_start_offset + HEAD.size,
        chunk.chunk_length - HEAD.size,
        chunk.message_start_time,
        chunk.message_end_time,
        indexes,
        (chunk.message_index_length - INDEX_HEAD * len(indexes)) // INDEX_ENTRY,
    )


def _content(body: bytes) -> bytes:
    """Return the records in a chunk. Raises any exception if its framing is wrong, or its checksum."""
    from mcap.data_stream import ReadDataStream
    from mcap.records import Chunk
    from mcap.stream_reader import get_chunk_data_stream

    chunk = Chunk.read(ReadDataStream(BytesIO(body)))
    stream, length = get_chunk_data_stream(chunk, validate_crc=True)
    content = stream.read(length)
    if length != chunk.uncompressed_size:
        raise ValueError("a chunk is not as long as it says")
    if not chunk.uncompressed_crc:
        for stamp_ns, _number, _raw in _split(content)[0]:
            if not chunk.message_start_time <= stamp_ns <= chunk.message_end_time:
                raise ValueError("a message is of another time than its chunk")
    return content


def _split(content: bytes) -> tuple[list[Found], list[tuple[int, bytes]]]:
    """Return the messages among some records, and the records of schemas and channels.

    The library's own way takes ten times as long. Raises ValueError if there is something else among them, or a
    single byte of their framing is wrong: nothing vouches then for those that look right.
    """
    found: list[Found] = []
    described = []
    at = 0
    while at < len(content):
        code, length = HEAD.unpack_from(content, at)
        begin = at + HEAD.size
        at = begin + length
        if at > len(content) or code not in {SCHEMA, CHANNEL, MESSAGE}:
            raise ValueError("there is no record where one should be")
        if code == MESSAGE:
            number, _sequence, stamp_ns, _sent_ns = MESSAGE_HEAD.unpack_from(content, begin)
            found.append((stamp_ns, number, content[begin + MESSAGE_HEAD.size : at]))
        else:
            described.append((code, content[begin:at]))
    return found, described


def _channel_of_mcap(channel: ChannelRecord, schema: Schema | None, messages: int) -> Channel:
    of_schema = schema.encoding if schema else ""
    is_idl = ROS2_SCHEMAS.get(of_schema)
    encoding = channel.message_encoding or CDR
    if is_idl is None and encoding == CDR:
        encoding = of_schema
    text = schema.data.decode(errors="replace") if schema and is_idl is not None else ""
    kind = TypeText(schema.name if schema else "", text, bool(is_idl))
    offer = files.offer_in(channel.metadata.get("offered_qos_profiles", ""))
    return Channel(channel.id, channel.topic, kind, messages, encoding, offer)

"""The files of a bag: MCAP read with the library `mcap`, SQLite with `rosbags`.

What is damaged is read as far as it goes, an SQLite file not at all; `graph.bag.reading` counts what is missing.
"""

from __future__ import annotations

import heapq
import sys
from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from contextlib import ExitStack
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
    from mcap.reader import SeekingReader
    from mcap.records import Channel as ChannelRecord
    from mcap.records import McapRecord, Schema
    from mcap.summary import Summary
    from rosbags.interfaces import Connection

CDR = "cdr"
Found: TypeAlias = "tuple[int, int, bytes]"
"""Unix time in nanoseconds, number of the channel, raw message."""
ROS2_SCHEMAS = {"ros2msg": False, "ros2idl": True, "omgidl": True, "": False}
"""Encoding of a schema that ROS 2 writes, to whether it is IDL."""
STEP_BYTES = 65_536
NOBODY = -1
"""No channel has this number."""


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


class Stretch(NamedTuple):
    """Some whole records of an MCAP file that follow each other."""

    begin: int
    end: int
    first_ns: int
    last_ns: int
    channels: frozenset[int]


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
    broken_ns: int | None = None

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
    """An open MCAP file: read by its summary if that is complete, else by what a look at all of it shows."""

    stack: ExitStack

    def __init__(self, file: Path, content: Path, stack: ExitStack) -> None:
        """Read `content`, which is called `file`. Raises what the library raises, and OSError."""
        from mcap.reader import SeekingReader

        self.file = file
        self.cut_bytes: int | None = None
        """Length of what cannot be read at the end; None if everything can, as far as is known."""
        self.broken_ns: int | None = None
        """Unix time of the last message before the place where it has turned out to be damaged."""
        self._content = content
        self._reader = SeekingReader(stack.enter_context(content.open("rb")), validate_crcs=True)
        summary = summary_of(self._reader)
        facts = summary.statistics if summary else None
        self.said = facts.message_count if facts else None
        """How many messages it holds by its own count, None if it keeps none."""
        self._stretches: list[Stretch] = []
        """What holds its messages, if the summary does not tell."""
        self._is_indexed = summary is not None and _is_complete(summary)
        if summary and facts and self._is_indexed:
            schemas, channels, counts = summary.schemas, summary.channels, facts.channel_message_counts
            self.start_ns, self.end_ns = facts.message_start_time, facts.message_end_time
            """Unix time of the first message and of the last, 0 if there is none."""
        else:
            schemas, channels, counts = self._scan()
        self.channels: Sequence[Channel] = [
            _channel_of_mcap(channel, schemas.get(channel.schema_id), counts.get(number, 0))
            for number, channel in sorted(channels.items())
        ]

    def messages(self, start_ns: int | None, numbers: Collection[int]) -> Iterator[Found]:
        """Yield messages of these channels in the order of their times, up to the first damaged place."""
        wanted, begin_ns = frozenset(numbers), start_ns or 0
        last_ns = max(begin_ns, self.start_ns)
        try:
            for stamp_ns, number, raw in (self._indexed if self._is_indexed else self._streamed)(begin_ns, wanted):
                if number in wanted and stamp_ns >= begin_ns:
                    last_ns = stamp_ns
                    yield stamp_ns, number, raw
        except Exception:  # noqa: BLE001 - the disk, a decompressor, or the content
            self.broken_ns = last_ns

    def _indexed(self, begin_ns: int, wanted: Collection[int]) -> Iterator[Found]:
        topics = {channel.topic for channel in self.channels if channel.number in wanted}
        for _schema, _channel, message in self._reader.iter_messages(topics, starting_at=begin_ns):
            yield message.log_time, message.channel_id, message.data

    def _streamed(self, begin_ns: int, wanted: Collection[int]) -> Iterator[Found]:
        with self._content.open("rb") as stream:
            stretches = [
                _of(each, stream)
                for each in self._stretches
                if each.last_ns >= begin_ns and not each.channels.isdisjoint(wanted)
            ]
            yield from heapq.merge(*stretches, key=itemgetter(0))

    def _scan(self) -> tuple[dict[int, Schema], dict[int, ChannelRecord], Counter[int]]:
        """Read all of it; return its schemas and channels by their numbers, and how many messages each has."""
        from mcap.records import Channel, Message, Schema

        schemas: dict[int, Schema] = {}
        channels: dict[int, ChannelRecord] = {}
        counts = Counter[int]()
        begin = at = 0
        found: list[tuple[int, int]] = []
        with self._content.open("rb") as stream:
            try:
                for records in _records(stream):
                    at = stream.tell()
                    for record in records:
                        if isinstance(record, Message):
                            counts[record.channel_id] += 1
                            found.append((record.log_time, record.channel_id))
                        elif isinstance(record, Channel):
                            channels[record.id] = record
                        elif isinstance(record, Schema):
                            schemas[record.id] = record
                    if found and at - begin >= STEP_BYTES:
                        self._stretches.append(_stretch(begin, at, found))
                        begin, found = at, []
            except Exception:  # noqa: BLE001 - as in `messages`
                self.cut_bytes = self._content.stat().st_size - at
        if found:
            self._stretches.append(_stretch(begin, at, found))
        self.start_ns = min((stretch.first_ns for stretch in self._stretches), default=0)
        self.end_ns = max((stretch.last_ns for stretch in self._stretches), default=0)
        return schemas, channels, counts


def _is_complete(summary: Summary) -> bool:
    """Return whether it tells of every chunk, channel and schema: a writer may leave out any of them."""
    facts, channels = summary.statistics, summary.channels
    if facts is None or not 0 < facts.chunk_count == len(summary.chunk_indexes):
        return False
    counts = facts.channel_message_counts
    schemas = {channel.schema_id for channel in channels.values()} - {0}
    is_counted = counts.keys() <= channels.keys() and sum(counts.values()) == facts.message_count
    return is_counted and schemas <= summary.schemas.keys()


def _records(stream: BinaryIO, *, inside: bool = False) -> Iterator[list[McapRecord]]:
    """Yield the records from here to the end, those of a chunk together; `inside`: this is not the beginning."""
    from mcap.records import Chunk
    from mcap.stream_reader import StreamReader, breakup_chunk

    for record in StreamReader(stream, skip_magic=inside, emit_chunks=True, validate_crcs=True).records:
        yield breakup_chunk(record, validate_crc=True) if isinstance(record, Chunk) else [record]


def _stretch(begin: int, end: int, found: Sequence[tuple[int, int]]) -> Stretch:
    stamps = [stamp_ns for stamp_ns, _number in found]
    return Stretch(begin, end, min(stamps), max(stamps), frozenset(number for _stamp_ns, number in found))


def _of(stretch: Stretch, stream: BinaryIO) -> Iterator[Found]:
    from mcap.records import Message

    # The merge takes one from each before it begins; not all should be read by then.
    yield stretch.first_ns, NOBODY, b""
    stream.seek(stretch.begin)
    found: list[Found] = []
    records = _records(stream, inside=stretch.begin > 0)
    while stream.tell() < stretch.end:
        messages = (record for record in next(records) if isinstance(record, Message))
        found += ((message.log_time, message.channel_id, message.data) for message in messages)
    yield from sorted(found, key=itemgetter(0))


BagPart: TypeAlias = "McapPart | SqlitePart"


def summary_of(reader: SeekingReader) -> Summary | None:
    """Return what an MCAP file says of itself at its end, None if nothing or if that is damaged."""
    try:
        return reader.get_summary()
    except Exception:  # noqa: BLE001 - whatever is wrong with it, the file itself tells
        return None


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

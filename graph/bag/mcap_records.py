"""The records of MCAP files, https://mcap.dev/spec, as far as a bag needs them."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from graph.bag.decoding import TypeText
from graph.bag.offers import offer_in
from graph.bag.part import CDR, Channel, Found

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
STATISTICS, DATA_END = 11, 15
IN_CHUNK = frozenset({SCHEMA, CHANNEL, MESSAGE})
PRIVATE = 0x80
"""Opcodes from here on are free for private use."""
RECORD_HEAD = struct.Struct("<BQ")
FOOTER_BODY = struct.Struct("<QQI")
"""Offset of the summary, offset of its own index, checksum."""
MESSAGE_HEAD = struct.Struct("<HIQQ")
INDEX_HEAD = 6
INDEX_ENTRY = 16
INDEX_RECORD = RECORD_HEAD.size + INDEX_HEAD
_CHUNK_HEAD = struct.Struct("<QQQI")
"""First and last time, size, and checksum of a chunk."""
_CHUNK_INDEX_HEAD = struct.Struct("<QQQQ")
_STATISTICS_HEAD = struct.Struct("<QHIIIIQQ")
_COUNT = struct.Struct("<HQ")
_SHORT = struct.Struct("<H")
_LENGTH = struct.Struct("<I")
_SIZE = struct.Struct("<Q")
ROS2_SCHEMAS = {"ros2msg": False, "ros2idl": True, "omgidl": True, "": False}
"""Encoding of a schema that ROS 2 writes, to whether it is IDL."""


class Stretch(NamedTuple):
    """A chunk, or adjacent records outside of chunks."""

    offset: int
    length: int
    first_ns: int
    last_ns: int
    counts: Mapping[int, int]
    """Channel to how many messages it has here."""
    is_chunk: bool = True


class Statistics(NamedTuple):
    """What a file counts of itself."""

    messages: int
    chunks: int
    counts: Mapping[int, int]


class _Schema(NamedTuple):
    name: str
    encoding: str
    text: str


@dataclass
class Described:
    """The channels of a file, and the types of their messages, as far as they have been met."""

    channels: dict[int, Channel] = field(default_factory=dict)
    _schemas: dict[int, _Schema] = field(default_factory=dict)

    def take(self, code: int, body: bytes) -> None:
        """Take a record; others than schemas and channels change nothing."""
        if code == SCHEMA:
            name, at = _text(body, _SHORT.size)
            encoding, at = _text(body, at)
            text, _at = _text(body, at)
            self._schemas[_number(body)] = _Schema(name, encoding, text)
        elif code == CHANNEL:
            self._take_channel(body)

    def _take_channel(self, body: bytes) -> None:
        (number_of_schema,) = _SHORT.unpack_from(body, _SHORT.size)
        topic, at = _text(body, 2 * _SHORT.size)
        encoding, at = _text(body, at)
        facts, _at = _bytes(body, at)
        schema = self._schemas.get(number_of_schema, _Schema("", "", ""))
        is_idl = ROS2_SCHEMAS.get(schema.encoding)
        encoding = encoding or CDR
        if is_idl is None and encoding == CDR:
            encoding = schema.encoding
        offer = offer_in(dict(_pairs(facts)).get("offered_qos_profiles", ""))
        kind = TypeText(schema.name, schema.text if is_idl is not None else "", bool(is_idl))
        number = _number(body)
        self.channels[number] = Channel(number, topic, kind, 0, encoding, *offer)


def records(raw: bytes) -> Iterator[tuple[int, int, int]]:
    """Yield code, begin and end of each record. Raises ValueError where one has no end."""
    at = 0
    while at < len(raw):
        if at + RECORD_HEAD.size > len(raw):
            raise ValueError("a record is cut short")
        code, length = RECORD_HEAD.unpack_from(raw, at)
        begin = at + RECORD_HEAD.size
        at = begin + length
        if at > len(raw):
            raise ValueError("a record is cut short")
        yield code, begin, at


def content_of(chunk: bytes) -> bytes:
    """Return the records in the body of a chunk's record.

    Raises any exception if its framing is wrong, or its checksum.
    """
    from rosbags.rosbag2.storage_mcap import decompress

    first_ns, last_ns, size, checksum = _CHUNK_HEAD.unpack_from(chunk)
    compression, at = _text(chunk, _CHUNK_HEAD.size)
    (packed,) = _SIZE.unpack_from(chunk, at)
    at += _SIZE.size
    if at + packed != len(chunk):
        raise ValueError("a chunk and what is in it differ in length")
    content = decompress(chunk[at:], compression, size, checksum)
    if not checksum:
        _check(content, first_ns, last_ns)
    return content


def _check(content: bytes, first_ns: int, last_ns: int) -> None:
    """Refuse content without a checksum whose messages are of another time than their chunk."""
    for stamp_ns, _channel, _raw in messages_in(content):
        if not first_ns <= stamp_ns <= last_ns:
            raise ValueError("a message is of another time than its chunk")


def messages_in(content: bytes) -> list[Found]:
    """Return the messages among some records.

    Raises any exception if there is something else among them, or a single byte of their framing
    is wrong: nothing vouches then for those that look right.
    """
    found: list[Found] = []
    for code, begin, end in records(content):
        if code not in IN_CHUNK:
            raise ValueError("there is no record where one should be")
        if code == MESSAGE:
            number, _sequence, stamp_ns, _sent_ns = MESSAGE_HEAD.unpack_from(content, begin)
            found.append((stamp_ns, number, content[begin + MESSAGE_HEAD.size : end]))
    return found


def chunk_index(body: bytes) -> Stretch:
    """Return where a chunk is, and what its message indexes count."""
    first_ns, last_ns, offset, length = _CHUNK_INDEX_HEAD.unpack_from(body)
    packed, at = _bytes(body, _CHUNK_INDEX_HEAD.size)
    (of_indexes,) = _SIZE.unpack_from(body, at)
    places = sorted((place, number) for number, place in _COUNT.iter_unpack(packed))
    ends = [*(place for place, _number_ in places[1:]), offset + length + of_indexes]
    counts = {
        number: max(0, end - place - INDEX_RECORD) // INDEX_ENTRY
        for (place, number), end in zip(places, ends, strict=False)
    }
    return Stretch(offset, length, first_ns, last_ns, counts)


def statistics(body: bytes) -> Statistics:
    """Return what a file counts of itself."""
    messages, _schemas, _channels, _attached, _facts, chunks, _first_ns, _last_ns = _STATISTICS_HEAD.unpack_from(body)
    packed, _at = _bytes(body, _STATISTICS_HEAD.size)
    return Statistics(messages, chunks, dict(_COUNT.iter_unpack(packed)))


def is_known(code: int) -> bool:
    """Return whether a record may have this code."""
    return 0 < code <= DATA_END or code >= PRIVATE


def _number(body: bytes) -> int:
    (number,) = _SHORT.unpack_from(body)
    return int(number)


def _bytes(body: bytes, at: int) -> tuple[bytes, int]:
    """Return what follows its own length, and the place behind it."""
    (length,) = _LENGTH.unpack_from(body, at)
    begin = at + _LENGTH.size
    if begin + length > len(body):
        raise ValueError("a text is cut short")
    return body[begin : begin + length], begin + length


def _text(body: bytes, at: int) -> tuple[str, int]:
    raw, end = _bytes(body, at)
    return raw.decode(errors="replace"), end


def _pairs(packed: bytes) -> Iterator[tuple[str, str]]:
    at = 0
    while at < len(packed):
        key, at = _text(packed, at)
        value, at = _text(packed, at)
        yield key, value

"""Bags as other programs, versions and accidents leave them."""

from __future__ import annotations

import sqlite3
import struct
from collections.abc import Mapping, Sequence
from pathlib import Path

import yaml
from mcap.records import Chunk
from mcap.stream_reader import StreamReader
from mcap.writer import CompressionType, IndexType, Writer

from tests.unit.bags import BEGIN_NS

TENTH_NS = 100_000_000
TEXT = "std_msgs/msg/String"
DEFINITION = b"string data\n"
TOPIC = "/chatter"
NUMBERED_QOS = "- history: 1\n  depth: 10\n  reliability: 2\n  durability: 1\n  deadline:\n    sec: 0\n    nsec: 0\n"
"""Best effort and transient local, as rosbag2 wrote it until Iron."""


def text_in_cdr(text: str) -> bytes:
    raw = text.encode() + b"\0"
    return b"\0\1\0\0" + struct.pack("<I", len(raw)) + raw


def times(first: int, count: int) -> Sequence[int]:
    return [BEGIN_NS + number * TENTH_NS for number in range(first, first + count)]


def write_mcap(
    file: Path,
    count: int = 20,
    first: int = 0,
    *,
    qos: str = "",
    foreign: tuple[str, str, str] | None = None,
    statistics: bool = True,
    indexes: IndexType = IndexType.ALL,
    compression: CompressionType = CompressionType.ZSTD,
    chunk_bytes: int = 2**20,
    topic: str = TOPIC,
    backwards: bool = False,
    summary: Mapping[str, bool] | None = None,
) -> Path:
    """A file with `count` texts on /chatter, and as many of a foreign channel if there is one.

    `foreign`: message encoding, name of the schema, and its encoding; `backwards`: the last message stands first;
    `summary`: what of it the writer leaves out, such as `repeat_channels`.
    """
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("wb") as stream:
        writer = Writer(
            stream,
            chunk_size=chunk_bytes,
            use_statistics=statistics,
            index_types=indexes,
            compression=compression,
            **(summary or {}),
        )
        writer.start("ros2", "a test")
        schema = writer.register_schema(TEXT, "ros2msg", DEFINITION)
        facts = {"offered_qos_profiles": qos} if qos else {}
        texts = writer.register_channel(topic, "cdr", schema, facts)
        other = None
        if foreign is not None:
            encoding, name, of_schema = foreign
            kind = writer.register_schema(name, of_schema, b"{}")
            other = writer.register_channel("/extra", encoding, kind)
        for number, at_ns in sorted(enumerate(times(first, count), first), reverse=backwards):
            writer.add_message(texts, at_ns, text_in_cdr(f"m{number}"), at_ns)
            if other is not None:
                writer.add_message(other, at_ns, b'{"a": 1}', at_ns)
        writer.finish()  # type: ignore[no-untyped-call]
    return file


def damage_chunk(file: Path, which: int, begin: int = 40) -> None:
    """Write wrong bytes into one of the chunks, from `begin` on."""
    chunks = []
    with file.open("rb") as stream:
        reader = StreamReader(stream, emit_chunks=True).records
        at = stream.tell()
        for record in reader:
            if isinstance(record, Chunk):
                chunks.append((at, stream.tell()))
            at = stream.tell()
    assert len(chunks) > 2
    at, end = chunks[which]
    raw = bytearray(file.read_bytes())
    raw[at + begin : end] = b"\xff" * (end - at - begin)
    file.write_bytes(raw)


def write_sqlite(file: Path, count: int = 20, first: int = 0) -> Path:
    """A file with `count` texts on /chatter."""
    file.parent.mkdir(parents=True, exist_ok=True)
    with sqlite3.connect(file) as base:
        base.execute(
            "create table topics(id integer primary key, name text, type text, "
            "serialization_format text, offered_qos_profiles text)"
        )
        base.execute("create table messages(id integer primary key, topic_id integer, timestamp integer, data blob)")
        base.execute("insert into topics values(1, ?, ?, 'cdr', '')", (TOPIC, TEXT))
        for number, at_ns in enumerate(times(first, count), first):
            row = (at_ns, text_in_cdr(f"m{number}"))
            base.execute("insert into messages(topic_id, timestamp, data) values(1, ?, ?)", row)
    base.close()
    return file


def write_metadata(
    folder: Path,
    named: Sequence[str],
    count: int = 20,
    *,
    topics: Mapping[str, object] | None = None,
    **facts: object,
) -> Path:
    """The metadata of a folder; `topics` and `facts` replace what is right of /chatter and all."""
    about = {"name": TOPIC, "type": TEXT, "serialization_format": "cdr", "offered_qos_profiles": "", **(topics or {})}
    content = {
        "version": 5,
        "storage_identifier": "mcap",
        "duration": {"nanoseconds": (count - 1) * TENTH_NS},
        "starting_time": {"nanoseconds_since_epoch": BEGIN_NS},
        "message_count": count,
        "topics_with_message_count": [{"topic_metadata": about, "message_count": count}],
        "compression_format": "",
        "compression_mode": "",
        "relative_file_paths": list(named),
        "files": [],
        **facts,
    }
    folder.mkdir(parents=True, exist_ok=True)
    text = yaml.safe_dump({"rosbag2_bagfile_information": content}, sort_keys=False)
    (folder / "metadata.yaml").write_text(text)
    return folder


def write_lossy_bag(folder: Path) -> Path:
    """A bag that holds 20 of the 40 messages that its metadata count."""
    write_mcap(folder / "lossy_0.mcap")
    return write_metadata(folder, ["lossy_0.mcap"], 40)

"""Writes a recording: a rosbag2 directory with an MCAP file, and the thread with a bounded queue in front of it.

A chunk is closed at least every second: everything up to the end of the last whole one can be read, whatever happens
afterwards, and `metadata.yaml` is there from the beginning.
"""

from __future__ import annotations

import contextlib
import os
import threading
import time
from collections import Counter, deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from graph.bag.errors import not_made, not_written
from graph.distro import distro
from text.sentences import Words

if TYPE_CHECKING:
    from pathlib import Path

    from rclpy.duration import Duration
    from rclpy.qos import QoSProfile

VERSION = 9
"""Of `metadata.yaml` in ROS 2 Jazzy."""
NANOSECONDS = 10**9
CHUNK_BYTES = 2**20
ROOM_BYTES = 2**20
"""Reserved beside the bag, so that it can be closed properly when the disk is full."""
RENEW_S = 5.0
"""How often `metadata.yaml` is rewritten."""
BUFFER_BYTES = 256_000_000
FLUSH_S = 1.0
"""Seconds of data that a crash may cost."""
QosOffer: TypeAlias = Mapping[str, Any]
"""One offered QoS profile, with the names that rosbag2 writes."""


@dataclass
class BagTopic:
    """One topic of a bag that is being written."""

    number: int
    """The number of its channel, counted from 1."""
    name: str
    type_name: str
    digest: str
    """`RIHS01_...` of the type; empty if not known."""
    offers: Sequence[QosOffer] = field(default_factory=tuple)
    messages: int = 0
    bytes: int = 0


class NewTopic(NamedTuple):
    """A topic, before its first message."""

    topic: BagTopic
    text: str
    """The definition of its type."""


class Message(NamedTuple):
    """One message on its way to the disk."""

    stamp_ns: int
    """When the middleware received it, unix time."""
    topic: BagTopic
    raw: bytes
    sent_ns: int
    """When it was sent, by the clock of its sender."""


class _Sound(NamedTuple):
    """How far the file is whole."""

    bytes: int
    first_ns: int = 0
    last_ns: int = 0
    counts: Mapping[int, tuple[int, int]] = {}
    """Topic number to its messages and bytes."""


class BagFile:
    """A rosbag2 directory that is being written; not thread-safe."""

    def __init__(self, folder: Path) -> None:
        """Create the folder, which must not exist yet. Raises BagError."""
        from mcap.writer import CompressionType, Writer

        self.topics: list[BagTopic] = []
        self.path = folder / f"{folder.name}.mcap"
        self._schemas: dict[str, int] = {}
        self._first_ns = self._last_ns = 0
        self._room = folder / ".room"
        self._renewed_s = 0.0
        try:
            folder.mkdir(parents=True)
            with self._room.open("wb") as room:
                os.posix_fallocate(room.fileno(), 0, ROOM_BYTES)
            self._stream = self.path.open("xb")
            # Packed chunks would cost a Raspberry Pi half a core.
            self._writer = Writer(self._stream, CHUNK_BYTES, CompressionType.NONE)
            self._writer.start("ros2", "deck")
            self._stream.flush()
            self._renew()
        except OSError as error:
            raise not_made(folder, error) from error
        self._sound = _Sound(self._stream.tell())

    def add_topic(self, topic: BagTopic, text: str) -> None:
        """Add a topic, numbered from 1; `text` is the definition of its type."""
        schema = self._schemas.get(topic.type_name)
        if schema is None:
            schema = self._writer.register_schema(topic.type_name, "ros2msg", text.encode())
            self._schemas[topic.type_name] = schema
        offers = _as_yaml([dict(offer) for offer in topic.offers])
        self._writer.register_channel(topic.name, "cdr", schema, {"offered_qos_profiles": offers})
        self.topics.append(topic)
        self._renewed_s = 0.0

    def write(self, topic: BagTopic, stamp_ns: int, sent_ns: int, raw: bytes) -> None:
        """Write a raw message, with the unix times of its arrival and sending. Raises OSError."""
        topic.messages += 1
        topic.bytes += len(raw)
        self._first_ns = min(self._first_ns or stamp_ns, stamp_ns)
        self._last_ns = max(self._last_ns, stamp_ns)
        self._writer.add_message(topic.number, stamp_ns, raw, sent_ns)
        if self._stream.tell() > self._sound.bytes:
            self._chunk_closed()

    def flush(self) -> None:
        """Hand everything written so far to the system. Raises OSError."""
        self._writer.flush()  # type: ignore[no-untyped-call]
        self._chunk_closed()
        if time.monotonic() - self._renewed_s >= RENEW_S:
            self._renew()

    def close(self) -> None:
        """Close the bag properly. Raises OSError."""
        self.flush()
        self._writer.add_metadata("rosbag2", {"serialized_metadata": _as_yaml(self._information())})
        self._writer.finish()  # type: ignore[no-untyped-call]
        self._stream.close()
        with contextlib.suppress(OSError):
            self._room.unlink()
        self._renew()

    def salvage(self) -> None:
        """After an OSError: cut the bag after the last whole chunk, and give it an end if possible.

        Messages after that chunk are removed from the counts.
        """
        sound = self._sound
        with contextlib.suppress(OSError):
            self._stream.close()
        with contextlib.suppress(OSError):
            self._room.unlink()
        for topic in self.topics:
            topic.messages, topic.bytes = sound.counts.get(topic.number, (0, 0))
        self._first_ns, self._last_ns = sound.first_ns, sound.last_ns
        with contextlib.suppress(OSError):
            os.truncate(self.path, sound.bytes)
            with self.path.open("ab") as file:
                file.write(_end_without_summary())
        with contextlib.suppress(OSError):
            self._renew()

    def _chunk_closed(self) -> None:
        self._stream.flush()
        counts = {topic.number: (topic.messages, topic.bytes) for topic in self.topics}
        self._sound = _Sound(self._stream.tell(), self._first_ns, self._last_ns, counts)

    def _renew(self) -> None:
        """Write or replace `metadata.yaml`; a complete one exists at any moment."""
        self._renewed_s = time.monotonic()
        fresh = self.path.with_name("metadata.yaml.new")
        fresh.write_text(_as_yaml({"rosbag2_bagfile_information": self._information()}), encoding="utf-8")
        fresh.replace(self.path.with_name("metadata.yaml"))

    def _information(self) -> dict[str, object]:
        return {
            "version": VERSION,
            "storage_identifier": "mcap",
            **self._facts(),
            "topics_with_message_count": [_stated(topic) for topic in self.topics],
            "compression_format": "",
            "compression_mode": "",
            "relative_file_paths": [self.path.name],
            # Made anew: YAML would write one object in two places as an alias.
            "files": [{"path": self.path.name, **self._facts()}],
            "custom_data": None,
            "ros_distro": distro(),
        }

    def _facts(self) -> dict[str, object]:
        return {
            "starting_time": {"nanoseconds_since_epoch": self._first_ns},
            "duration": {"nanoseconds": self._last_ns - self._first_ns},
            "message_count": sum(topic.messages for topic in self.topics),
        }


def qos_offer(profile: QoSProfile) -> QosOffer:
    """Return the QoS that a publisher offers, as rosbag2 writes it."""
    return {
        "history": profile.history.name.lower(),
        "depth": profile.depth,
        "reliability": profile.reliability.name.lower(),
        "durability": profile.durability.name.lower(),
        "deadline": _time(profile.deadline),
        "lifespan": _time(profile.lifespan),
        "liveliness": profile.liveliness.name.lower(),
        "liveliness_lease_duration": _time(profile.liveliness_lease_duration),
        "avoid_ros_namespace_conventions": profile.avoid_ros_namespace_conventions,
    }


def _time(duration: Duration) -> dict[str, int]:
    seconds, nanoseconds = divmod(duration.nanoseconds, NANOSECONDS)
    return {"sec": seconds, "nsec": nanoseconds}


def _stated(topic: BagTopic) -> dict[str, object]:
    return {
        "topic_metadata": {
            "name": topic.name,
            "type": topic.type_name,
            "serialization_format": "cdr",
            "offered_qos_profiles": [dict(offer) for offer in topic.offers],
            "type_description_hash": topic.digest,
        },
        "message_count": topic.messages,
    }


def _as_yaml(content: object) -> str:
    """Return YAML with the keys in their given order."""
    import yaml

    text: str = yaml.safe_dump(content, sort_keys=False, default_flow_style=False)
    return text


def _end_without_summary() -> bytes:
    """Return what ends an MCAP file properly; readers find its messages without an index."""
    from mcap.data_stream import RecordBuilder
    from mcap.records import DataEnd, Footer
    from mcap.writer import MCAP0_MAGIC

    builder = RecordBuilder()
    DataEnd(0).write(builder)
    Footer(0, 0, 0).write(builder)
    return bytes(builder.end()) + MCAP0_MAGIC  # type: ignore[no-untyped-call]


class RecordingWriter:
    """Writes messages on a thread of its own; those dropped because the disk is too slow are counted."""

    def __init__(self, file: BagFile, limit_bytes: int = BUFFER_BYTES) -> None:
        """Start at once to write to `file`, with at most `limit_bytes` waiting."""
        self.error: Words | None = None
        """Why nothing is written any more."""
        self.dropped: Counter[str] = Counter()
        """Topic to the number of its messages that found the buffer full."""
        self.waiting_bytes = 0
        """Bytes that are not written yet."""
        self._file = file
        self._limit_bytes = limit_bytes
        self._waiting: deque[NewTopic | Message] = deque()
        self._in_hand: deque[NewTopic | Message] = deque()
        self._news = threading.Condition()
        self._ending = False
        self._thread = threading.Thread(target=self._run, name="deck-recording", daemon=True)
        self._thread.start()

    def add_topic(self, topic: BagTopic, text: str) -> None:
        """Add a topic; `text` is the definition of its type."""
        with self._news:
            self._waiting.append(NewTopic(topic, text))

    def put(self, messages: Sequence[Message]) -> None:
        """Add messages in the order of their stamps; never waits."""
        with self._news:
            for message in messages:
                size = len(message.raw)
                if self.error or self.waiting_bytes + size > self._limit_bytes:
                    self.dropped[message.topic.name] += 1
                else:
                    self._waiting.append(message)
                    self.waiting_bytes += size
            self._news.notify()

    def finish(self, within_s: float) -> bool:
        """Write what waits and close the file; return whether that was done in time."""
        with self._news:
            self._ending = True
            self._news.notify()
        self._thread.join(within_s)
        return not self._thread.is_alive()

    def _run(self) -> None:
        try:
            self._write_till_the_end()
            self._file.close()
        except OSError as error:
            self._give_up(error)

    def _give_up(self, error: OSError) -> None:
        """Close the file as well as possible, and count what is not in it."""
        with self._news:
            self.error = not_written(self._file.path, error)
            for item in (*self._in_hand, *self._waiting):
                if isinstance(item, Message):
                    self.dropped[item.topic.name] += 1
            self._in_hand.clear()
            self._waiting.clear()
            self.waiting_bytes = 0
        before = {topic.name: topic.messages for topic in self._file.topics}
        self._file.salvage()
        for topic in self._file.topics:
            self.dropped[topic.name] += before[topic.name] - topic.messages

    def _write_till_the_end(self) -> None:
        flush_at_s = time.monotonic() + FLUSH_S
        while self._take(flush_at_s):
            while self._in_hand:
                item = self._in_hand.popleft()
                if isinstance(item, NewTopic):
                    self._file.add_topic(item.topic, item.text)
                else:
                    self._file.write(item.topic, item.stamp_ns, item.sent_ns, item.raw)
                    with self._news:
                        self.waiting_bytes -= len(item.raw)
                flush_at_s = self._flush_at(flush_at_s)
            flush_at_s = self._flush_at(flush_at_s)

    def _flush_at(self, flush_at_s: float) -> float:
        """Flush if it is time; return the next time."""
        if time.monotonic() < flush_at_s:
            return flush_at_s
        self._file.flush()
        return time.monotonic() + FLUSH_S

    def _take(self, until_s: float) -> bool:
        """Write what waits, as soon as anything does; return False when nothing more will come."""
        with self._news:
            if not self._waiting and not self._ending:
                self._news.wait(max(0.0, until_s - time.monotonic()))
            self._in_hand, self._waiting = self._waiting, deque()
            return bool(self._in_hand) or not self._ending

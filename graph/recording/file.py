"""Writes one rosbag2 directory: an MCAP file in chunks, and `metadata.yaml`.

The storage class of the library `rosbags` writes the MCAP file. The library's `Writer` lacks what
protects a bag in a crash: chunks written to disk every second, and metadata from the beginning. So
the storage class is used without it, and told when to close a chunk. Everything up to the end of
the last whole chunk can be read, whatever happens afterwards.
"""

from __future__ import annotations

import contextlib
import io
import os
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rosbags.interfaces import Connection, ConnectionExtRosbag2, MessageDefinition, MessageDefinitionFormat
from rosbags.rosbag2.storage_mcap import PendingChunk

from graph.bag.errors import not_made
from graph.bag.metadata import VERSION, BagTopic, as_yaml, information, write
from graph.recording.mcap import McapFile

if TYPE_CHECKING:
    from pathlib import Path

ROOM_BYTES = 2**20
"""Reserved beside the bag, so that it can be closed properly when the disk is full."""
RENEW_S = 5.0
"""How often `metadata.yaml` is rewritten."""


@dataclass
class _Sound:
    """How far the file is whole."""

    bytes: int
    chunks: int = 0
    last_ns: int = 0
    counts: dict[int, tuple[int, int]] = field(default_factory=dict)
    """Topic number to its messages and bytes."""


class BagFile:
    """Stores topics and their raw messages; not thread-safe."""

    def __init__(self, folder: Path) -> None:
        """Create the folder, which must not exist yet. Raises BagError."""
        self.topics: list[BagTopic] = []
        self._folder = folder
        self._types: set[str] = set()
        self._connections: dict[int, Connection] = {}
        self._room = folder / ".room"
        self._renewed_s = 0.0
        try:
            folder.mkdir(parents=True)
            self._storage = McapFile(folder)
            self._keep_room()
            self._storage.bio.flush()
            self._renew()
        except OSError as error:
            raise not_made(folder, error) from error
        self._sound = _Sound(self._storage.bio.tell())

    @property
    def path(self) -> Path:
        return self._storage.path

    def add_topic(self, topic: BagTopic, text: str) -> None:
        """Add a topic, numbered from 1; `text` is the definition of its type."""
        connection = Connection(
            topic.number,
            topic.name,
            topic.type_name,
            MessageDefinition(MessageDefinitionFormat.MSG, text),
            topic.digest,
            0,
            ConnectionExtRosbag2("cdr", []),
            self,
        )
        if topic.type_name not in self._types:
            self._types.add(topic.type_name)
            self._storage.add_msgtype(connection)
        offers = as_yaml([dict(offer) for offer in topic.offers])
        self._storage.add_connection(connection, offers)
        self.topics.append(topic)
        self._connections[topic.number] = connection
        self._renewed_s = 0.0

    def write(self, topic: BagTopic, stamp_ns: int, sent_ns: int, raw: bytes) -> None:
        """Write a raw message, with the unix times of its arrival and sending. Raises OSError."""
        chunks = len(self._storage.chunks)
        topic.messages += 1
        topic.bytes += len(raw)
        self._storage.put(self._connections[topic.number], stamp_ns, sent_ns, raw)
        if len(self._storage.chunks) > chunks:
            self._chunk_closed()

    def flush(self) -> None:
        """Hand everything written so far to the system. Raises OSError."""
        if self._storage.chunk.msgs:
            self._storage.close_chunk()
            self._chunk_closed()
        if time.monotonic() - self._renewed_s >= RENEW_S:
            self._renew()

    def close(self) -> None:
        """Close the bag properly. Raises OSError."""
        self.flush()
        self._end()

    def salvage(self) -> None:
        """After an OSError: cut the bag after the last whole chunk, and close it if possible.

        Messages after that chunk are removed from the counts.
        """
        storage, sound = self._storage, self._sound
        with contextlib.suppress(OSError):
            storage.bio.close()
        with contextlib.suppress(OSError):
            self._room.unlink()
        for topic in self.topics:
            topic.messages, topic.bytes = sound.counts.get(topic.number, (0, 0))
        del storage.chunks[sound.chunks :]
        storage.channel_stats = {topic.number: topic.messages for topic in self.topics}
        storage.message_end_time = sound.last_ns
        storage.chunk = PendingChunk(0, 0, io.BytesIO(), {})
        try:
            os.truncate(storage.path, sound.bytes)
            storage.bio = storage.path.open("ab")
            self._end()
        except OSError:
            with contextlib.suppress(OSError):
                storage.bio.close()
            # Whole chunks can be read without an index; half an index would be in the way.
            with contextlib.suppress(OSError):
                os.truncate(storage.path, sound.bytes)
            with contextlib.suppress(OSError):
                self._renew()

    def _chunk_closed(self) -> None:
        self._storage.bio.flush()
        counts = {topic.number: (topic.messages, topic.bytes) for topic in self.topics}
        self._sound = _Sound(
            self._storage.bio.tell(), len(self._storage.chunks), self._storage.message_end_time, counts
        )

    def _end(self) -> None:
        storage = self._storage
        if not storage.message_end_time:
            storage.message_start_time = storage.chunk.message_start_time = 0
        storage.close(VERSION, as_yaml(self._information()))
        with contextlib.suppress(OSError):
            self._room.unlink()
        self._renew()

    def _information(self) -> dict[str, object]:
        storage = self._storage
        times = storage.message_start_time, storage.message_end_time
        return information(storage.path.name, self.topics, *times)

    def _renew(self) -> None:
        self._renewed_s = time.monotonic()
        write(self._folder, self._information())

    def _keep_room(self) -> None:
        with self._room.open("wb") as file:
            os.posix_fallocate(file.fileno(), 0, ROOM_BYTES)

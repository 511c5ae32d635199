"""The recorder: a ROS node and a thread of its own that put raw messages into a rosbag2 directory.

Queues are emptied in turn and nothing is decoded; another thread writes to the disk. Messages lost
on the way, by the middleware or because the disk is too slow, are counted and reported.
"""

from __future__ import annotations

import atexit
import logging
import os
import threading
import time
from collections import deque
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from graph.bag.errors import BagError
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from collections.abc import Set as AbstractSet

    from graph.recording.topics import RecordingTopics
    from graph.recording.writer import BagFile, RecordingWriter
    from text.sentences import Words

logger = logging.getLogger(__name__)

TURN_S = 0.05
LOOK_S = 0.25
"""How often to empty the queues, and how often to look for new topics."""
FINISH_WITHIN_S = 30.0
SLOW_BYTES = 64_000_000
"""With this much waiting, the disk is reported as slow."""
RESERVE_BYTES = 500_000_000
"""Kept free: what waits in memory must still fit, and a system with a full disk fails elsewhere."""
WINDOW_S = 5.0
"""Time over which the rate is measured."""
MEGA = 1e6


@dataclass(frozen=True)
class RecordedTopic:
    """One topic of a recording."""

    name: str
    type_name: str
    messages: int
    bytes: int
    lost: int = 0
    """Published but not recorded."""


@dataclass(frozen=True)
class RecordingStatus:
    """The state of a recording."""

    folder: str
    since_s: float
    """Unix time."""
    seconds: float
    messages: int = 0
    bytes: int = 0
    """Size of the serialized messages."""
    topics: tuple[RecordedTopic, ...] = ()
    lost: int = 0
    """Messages that are missing, for whatever reason."""
    dropped: int = 0
    """Those missing because the disk was too slow, or full."""
    bytes_per_s: float = 0.0
    """How fast the recording grows, over the last seconds."""
    left_s: float | None = None
    """How long the disk has room at this rate; None if unknown."""
    slow: bool = False
    """Whether the disk does not keep up."""
    error: str = ""
    """Why nothing is recorded any more, as translatable words."""
    skipped: Mapping[str, str] = field(default_factory=dict)
    """Topic to why it cannot be recorded."""
    absent: tuple[str, ...] = ()
    """Topics that were asked for but that nobody has published so far."""
    ended: bool = False


def room_bytes(folder: Path) -> int | None:
    """Return how much a recording in this folder may grow to; None if the disk does not say.

    The folder need not exist yet.
    """
    try:
        return max(0, free_bytes(folder) - RESERVE_BYTES)
    except OSError:
        return None


def free_bytes(folder: Path) -> int:
    """Return how many bytes an ordinary user may still write where this folder is, or will be."""
    while not folder.exists() and folder != folder.parent:
        folder = folder.parent
    found = os.statvfs(folder)
    return found.f_bavail * found.f_frsize


class DiskRoom:
    """Watches a folder's disk during a recording."""

    def __init__(
        self, folder: Path, reserve_bytes: int = RESERVE_BYTES, free: Callable[[Path], int] | None = None
    ) -> None:
        """`free` returns how many bytes are free at a folder; by default it asks the system.

        It may raise OSError.
        """
        self.bytes_per_s = 0.0
        """How fast the recording grows, over the last seconds."""
        self.left_s: float | None = None
        """How long it may still continue at this rate; None if unknown."""
        self.end: Words | None = None
        """Why the recording must stop now."""
        self._folder = folder
        self._reserve_bytes = reserve_bytes
        self._free = free or free_bytes
        self._seen: deque[tuple[float, int]] = deque()

    def check(self) -> None:
        """Raise BagError if there is no room to begin with."""
        try:
            free = self._free(self._folder)
        except OSError:
            return  # Creating the folder will give a better error.
        if free <= self._reserve_bytes:
            raise BagError(
                say(
                    "{path}: {free} MB are free on this disk, and {reserve} MB must stay free: "
                    "free some space, or record into a folder on another disk",
                    path=self._folder,
                    free=round(free / MEGA),
                    reserve=round(self._reserve_bytes / MEGA),
                )
            )

    def look(self, now_s: float, written_bytes: int) -> None:
        """Note how much has been recorded by now, and how much is free."""
        self._seen.append((now_s, written_bytes))
        while len(self._seen) > 2 and self._seen[1][0] <= now_s - WINDOW_S:
            self._seen.popleft()
        then_s, then_bytes = self._seen[0]
        if now_s > then_s:
            self.bytes_per_s = (written_bytes - then_bytes) / (now_s - then_s)
        try:
            free = self._free(self._folder)
        except OSError:
            self.left_s = None
            return
        spare = free - self._reserve_bytes
        self.left_s = max(0.0, spare / self.bytes_per_s) if self.bytes_per_s > 0 else None
        if spare <= 0:
            self.end = say(
                "recording has stopped: {free} MB are free on the disk of {path}. Everything "
                "recorded so far is intact. Free some space and record again",
                free=round(free / MEGA),
                path=self._folder,
            )


class Recorder:
    """Records topics of one domain from `start` to `stop`. `status` may be read at any time."""

    def __init__(
        self,
        domain: int,
        discovery: str | tuple[str, ...],
        folder: Path,
        topics: Sequence[str] | None = None,
        *,
        hidden: bool = False,
        without: AbstractSet[str] = frozenset(),
    ) -> None:
        """`topics`: None for all, including those that appear later.

        With `hidden`, all includes the inner topics of actions; the types `without` are left out.
        It stops by itself when no more than `RESERVE_BYTES` are free on the disk.
        """
        self._domain = domain
        self._discovery = discovery
        self._folder = folder
        self._choice = None if topics is None else frozenset(topics), hidden, without
        self._room = DiskRoom(folder)
        self._error = ""
        self._since_s = time.time()
        self._begun_s = time.monotonic()
        self._ended_s: float | None = None
        self._stopping = threading.Event()
        self._thread: threading.Thread | None = None
        self._writer: RecordingWriter | None = None
        self._topics: RecordingTopics | None = None

    def start(self) -> None:
        """Create the folder and begin. Raises BagError if that fails or the disk is full."""
        from graph.recording.writer import BagFile

        self._room.check()
        file = BagFile(self._folder)
        self._thread = threading.Thread(target=self._run, args=(file,), name="deck-recorder", daemon=True)
        # DDS threads must end before the interpreter does.
        atexit.register(self.stop)
        self._thread.start()

    def stop(self) -> RecordingStatus:
        """Close the bag properly; returns within half a minute, whatever the disk does."""
        self._stopping.set()
        atexit.unregister(self.stop)
        if self._thread is not None:
            self._thread.join(FINISH_WITHIN_S + 5)
        return self.status

    @property
    def status(self) -> RecordingStatus:
        until_s = time.monotonic() if self._ended_s is None else self._ended_s
        writer, topics = self._writer, self._topics
        common = (str(self._folder), self._since_s, until_s - self._begun_s)
        if writer is None or topics is None:
            return RecordingStatus(*common, error=self._error, ended=self._ended_s is not None)
        rows = tuple(
            RecordedTopic(
                tap.topic.name,
                tap.topic.type_name,
                tap.topic.messages,
                tap.topic.bytes,
                tap.lost + writer.dropped[tap.topic.name],
            )
            for tap in topics.all()
        )
        return RecordingStatus(
            *common,
            messages=sum(row.messages for row in rows),
            bytes=sum(row.bytes for row in rows),
            topics=rows,
            lost=sum(row.lost for row in rows),
            dropped=sum(writer.dropped.values()),
            bytes_per_s=self._room.bytes_per_s,
            left_s=self._room.left_s,
            slow=writer.waiting_bytes > SLOW_BYTES,
            error=writer.error or self._error,
            skipped=dict(topics.skipped),
            absent=topics.absent(),
            ended=self._ended_s is not None,
        )

    def _run(self, file: BagFile) -> None:
        from graph.recording.writer import RecordingWriter

        writer = RecordingWriter(file)
        try:
            self._record(writer)
        except Exception as error:
            logger.exception("the recorder failed")
            self._error = say("ROS cannot be used: {reason}", reason=error)
        finally:
            if not writer.finish(FINISH_WITHIN_S) and not writer.error:
                self._error = say(
                    "{path}: the disk does not accept the recorded data; the bag may be cut short", path=file.path
                )
            self._ended_s = time.monotonic()

    def _record(self, writer: RecordingWriter) -> None:
        # This imports rclpy; the caller need not wait for it.
        from graph.recording.topics import RecordingTopics, TopicChoice
        from graph.ros import open_ros

        ros = open_ros(self._domain, self._discovery, "recorder")
        try:
            topics = RecordingTopics(ros.node, TopicChoice(*self._choice), writer)
            self._topics, self._writer = topics, writer
            self._take_turns(topics, writer)
            topics.close()
        finally:
            ros.close()

    def _take_turns(self, topics: RecordingTopics, writer: RecordingWriter) -> None:
        look_at_s = 0.0
        # When the disk is full, messages that come before `stop` are counted as dropped.
        while True:
            ending = self._stopping.is_set() or bool(self._error)
            if time.monotonic() >= look_at_s:
                topics.look()
                self._look_at_room(topics)
                look_at_s = time.monotonic() + LOOK_S
            messages = topics.drain()
            if messages:
                writer.put(messages)
            if ending:
                return
            self._stopping.wait(TURN_S)

    def _look_at_room(self, topics: RecordingTopics) -> None:
        self._room.look(time.monotonic(), sum(tap.topic.bytes for tap in topics.all()))
        if self._room.end is not None:
            self._error = self._room.end

"""`~/frames`: the traffic of a serial port, in words, while somebody is subscribed.

Without subscribers, bytes are not even kept. See robot/frames/lines.py for the format.
"""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING

from std_msgs.msg import String

from nodes.parts.node import change_period
from robot.frames.batches import Chunk, FrameBatcher
from robot.frames.lines import encode

if TYPE_CHECKING:
    from collections.abc import Callable

    from nodes.parts.node import LessonNode
    from robot.frames.protocols import FrameReader

FRAMES = "~/frames"
_LOOK_EVERY_S = 1.0
"""How often to check whether somebody is subscribed."""
_TELL_EVERY_S = 0.2
_MOST_OCTETS = 16_384
"""Bytes kept per batch: nobody could read the frames of more."""


class SerialFrames:
    """Collects bytes for a batch, and publishes it from the node's thread."""

    def __init__(self, node: LessonNode, make: Callable[[str], FrameReader]) -> None:
        """`make` creates a reader of this device's frames for a language."""
        self._publisher = node.quick_publisher(String, FRAMES)
        self._batcher = FrameBatcher(make, node.say.language)
        self._wanted = False
        self._lock = threading.Lock()
        self._chunks: list[Chunk] = []
        self._octets = self._missed = 0
        self._timer = node.every(_LOOK_EVERY_S, self._look)

    def note(self, way: str, octets: bytes) -> None:
        """Note bytes that went `in` or `out`. From any thread."""
        if not self._wanted:
            return
        chunk = Chunk(time.time(), way, octets)
        with self._lock:
            if self._octets + len(octets) > _MOST_OCTETS:
                self._missed += len(octets)
                return
            self._octets += len(octets)
            self._chunks.append(chunk)

    def _look(self) -> None:
        wanted = self._publisher.get_subscription_count() > 0
        if wanted != self._wanted:
            self._wanted = wanted
            self._batcher.restart()
            self._take()
            change_period(self._timer, _TELL_EVERY_S if wanted else _LOOK_EVERY_S)
        elif wanted:
            self._tell()

    def _tell(self) -> None:
        chunks, missed = self._take()
        lines = self._batcher.tell(chunks, time.time(), missed)
        if lines:
            self._publisher.publish(String(data=encode(lines)))

    def _take(self) -> tuple[list[Chunk], int]:
        with self._lock:
            taken = self._chunks, self._missed
            self._chunks, self._octets, self._missed = [], 0, 0
        return taken

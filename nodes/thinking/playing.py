"""The model's voice on its way to the loudspeaker, at its own pace: so it can be broken off."""

from __future__ import annotations

from typing import TYPE_CHECKING

from std_msgs.msg import ByteMultiArray

from nodes.parts.qos import DEPTH
from nodes.parts.sound import to_message
from robot.sound import SAMPLE
from robot.topics import SPEAKER

if TYPE_CHECKING:
    from nodes.parts.node import LessonNode

BLOCK_S = 0.1
_AHEAD = 3
"""Blocks that are published at once at the beginning: what the loudspeaker may be late by."""


class PacedSpeaker:
    """Publishes sound on /audio/speaker_raw at the pace at which it is played."""

    def __init__(self, node: LessonNode, rate_hz: int) -> None:
        self._publisher = node.create_publisher(ByteMultiArray, SPEAKER, DEPTH)
        self._block = round(rate_hz * BLOCK_S) * SAMPLE
        self._waiting = bytearray()
        self._ahead = 0
        node.every(BLOCK_S, self._tick)

    def play(self, pcm: bytes) -> None:
        """Have this played after what waits already."""
        self._waiting += pcm
        while self._waiting and self._ahead < _AHEAD:
            self._publish()

    def drop(self) -> None:
        """Play nothing of what waits."""
        self._waiting.clear()

    def _tick(self) -> None:
        self._ahead = max(0, self._ahead - 1)
        if self._waiting:
            self._publish()

    def _publish(self) -> None:
        self._ahead += 1
        self._publisher.publish(to_message(bytes(self._waiting[: self._block])))
        del self._waiting[: self._block]

"""The newest position of each joint of the robot, as drivers report it in JointState messages."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from sensor_msgs.msg import JointState

from nodes.parts.qos import DEPTH
from space.robot_model import is_position
from text.i18n import N_

if TYPE_CHECKING:
    from collections.abc import Collection

    from builtin_interfaces.msg import Time

    from nodes.parts.node import LessonNode

_SAY_EVERY_S = 5.0
_MOST_STRANGERS = 20
"""Unknown joints that are named: a driver may invent any number."""

_UNEVEN = N_("{topic} is ignored: it has {names} names and {positions} positions")
_ONLY_SPEEDS = N_("{topic} is ignored: it has speeds, but no positions of the joints")
_NOWHERE = N_("{topic}: {joint} cannot be at {position:g}; it is ignored")
_STRANGER = N_("{topic}: the robot has no joint {joint}; it is ignored")


@dataclass(frozen=True, slots=True)
class HeardPosition:
    """Where a joint was, radians or metres."""

    position: float
    stamp: Time
    """As its driver says."""
    heard_s: float
    """On the clock of `time.monotonic`."""


class JointPositions:
    """Listens to topics; what is not a position of a joint is said and ignored."""

    def __init__(self, node: LessonNode, topics: Collection[str], joints: Collection[str]) -> None:
        self._say = node.say
        self._joints = joints
        self._strangers: set[str] = set()
        self.heard: dict[str, HeardPosition] = {}
        for topic in topics:
            node.create_subscription(JointState, topic, partial(self._hear, topic), DEPTH)

    def _hear(self, topic: str, message: JointState) -> None:
        names, positions = message.name, message.position
        if not positions:
            # A head that has not moved yet says that it does not know.
            if len(message.velocity):
                self._say.warn(_ONLY_SPEEDS, every_s=_SAY_EVERY_S, topic=topic)
            return
        if len(names) != len(positions):
            self._say.warn(
                _UNEVEN,
                every_s=_SAY_EVERY_S,
                topic=topic,
                names=len(names),
                positions=len(positions),
            )
            return
        now_s = time.monotonic()
        for joint, position in zip(names, positions, strict=True):
            if joint not in self._joints:
                self._tell_stranger(topic, joint)
            elif is_position(position):
                self.heard[joint] = HeardPosition(position, message.header.stamp, now_s)
            else:
                self._say.warn(
                    _NOWHERE, every_s=_SAY_EVERY_S, topic=topic, joint=joint, position=position
                )

    def _tell_stranger(self, topic: str, joint: str) -> None:
        if joint not in self._strangers and len(self._strangers) < _MOST_STRANGERS:
            self._strangers.add(joint)
            self._say.warn(_STRANGER, topic=topic, joint=joint)

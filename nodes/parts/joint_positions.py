"""The newest position of each joint of the robot, as drivers report it in JointState messages.

Drivers report 50 times a second, and waking up is most of what hearing costs: messages wait in
their queues until somebody takes them.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rclpy.callback_groups import CallbackGroup
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState

from space.robot_model import is_position
from text.i18n import N_

if TYPE_CHECKING:
    from collections.abc import Collection

    from builtin_interfaces.msg import Time
    from rclpy.subscription import Subscription

    from nodes.parts.node import LessonNode

_QUEUE = QoSProfile(depth=50, reliability=ReliabilityPolicy.BEST_EFFORT)
"""From publishers of any reliability; several may share a topic, each with joints of its own."""
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
    """Subscribes to topics; what is not a position of a joint is said and ignored."""

    def __init__(self, node: LessonNode, topics: Collection[str], joints: Collection[str]) -> None:
        self._say = node.say
        self._joints = joints
        self._strangers: set[str] = set()
        self.heard: dict[str, HeardPosition] = {}
        unheard, quiet = _NeverWaitedFor(), SubscriptionEventCallbacks(use_default_callbacks=False)
        self._subscriptions: list[Subscription] = [
            node.create_subscription(
                JointState, topic, _never_called, _QUEUE, callback_group=unheard, event_callbacks=quiet
            )
            for topic in topics
        ]

    def take(self) -> None:
        """Take what has come since the last time."""
        for subscription in self._subscriptions:
            handle = subscription.handle
            with handle:
                # A publisher that is faster than this loop must not keep it busy for ever.
                for _ in range(_QUEUE.depth):
                    taken = handle.take_message(JointState, False)
                    if taken is None:
                        break
                    self._hear(subscription.topic_name, taken[0])

    def _hear(self, topic: str, message: JointState) -> None:
        names, positions = message.name, message.position
        if not positions:
            # A head that has not moved yet says that it does not know.
            if len(message.velocity):
                self._say.warn(_ONLY_SPEEDS, every_s=_SAY_EVERY_S, topic=topic)
            return
        if len(names) != len(positions):
            self._say.warn(_UNEVEN, every_s=_SAY_EVERY_S, topic=topic, names=len(names), positions=len(positions))
            return
        now_s = time.monotonic()
        for joint, position in zip(names, positions, strict=True):
            if joint not in self._joints:
                self._tell_stranger(topic, joint)
            elif is_position(position):
                self.heard[joint] = HeardPosition(position, message.header.stamp, now_s)
            else:
                self._say.warn(_NOWHERE, every_s=_SAY_EVERY_S, topic=topic, joint=joint, position=position)

    def _tell_stranger(self, topic: str, joint: str) -> None:
        if joint not in self._strangers and len(self._strangers) < _MOST_STRANGERS:
            self._strangers.add(joint)
            self._say.warn(_STRANGER, topic=topic, joint=joint)


class _NeverWaitedFor(CallbackGroup):
    """Subscriptions that the executor passes over."""

    def can_execute(self, _entity: object) -> bool:
        return False

    def beginning_execution(self, _entity: object) -> bool:
        return False

    def ending_execution(self, _entity: object) -> None:
        pass


def _never_called(_message: JointState) -> None:
    """Stand in for the callback that rclpy insists on."""

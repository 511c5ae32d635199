"""Subscribes to a sensor, and to /odom."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from nav_msgs.msg import Odometry
from rclpy.event_handler import QoSRequestedIncompatibleQoSInfo, SubscriptionEventCallbacks
from rclpy.qos import QoSPolicyKind, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription

from nodes.parts.node import DEPTH, NEWEST_OF_ANY, LessonNode
from robot.motion.odometry import Pose, yaw_from_quaternion
from robot.topics import ODOMETRY
from text.i18n import N_


class SensorListener:
    """Subscribes reliably, or as best effort from the first publisher on that offers no more.

    A best-effort request would match both, but would then lose most large pictures, which travel in
    many fragments, of a reliable publisher. So best effort is requested only if nothing else is
    offered.
    """

    def __init__(
        self,
        node: LessonNode,
        kind: type[Any],
        topic: str,
        hear: Callable[[Any], None],
        *,
        depth: int = DEPTH,
        raw: bool = False,
    ) -> None:
        """`hear` is called with each message, or with its bytes if `raw`."""
        self._node, self._kind, self._topic = node, kind, topic
        self._hear, self._depth, self._raw = hear, depth, raw
        self._relaxed = False
        self._subscription = self._subscribed(
            ReliabilityPolicy.RELIABLE, SubscriptionEventCallbacks(incompatible_qos=self._relax)
        )

    def _subscribed(
        self, reliability: ReliabilityPolicy, events: SubscriptionEventCallbacks | None = None
    ) -> Subscription:
        return self._node.create_subscription(
            self._kind,
            self._topic,
            self._hear,
            QoSProfile(depth=self._depth, reliability=reliability),
            event_callbacks=events,
            raw=self._raw,
        )

    def _relax(self, told: QoSRequestedIncompatibleQoSInfo) -> None:
        if self._relaxed or told.last_policy_kind != QoSPolicyKind.RELIABILITY:
            return
        self._relaxed = True
        strict, self._subscription = (self._subscription, self._subscribed(ReliabilityPolicy.BEST_EFFORT))
        self._node.destroy_subscription(strict)


ODOM = "odom"
"""The frame of the poses on /odom (REP-105)."""
_NO_NUMBER = N_("{topic} is not a number and is ignored")


class OdometryListener:
    """Keeps the newest pose; one with nan or infinity is ignored."""

    def __init__(self, node: LessonNode) -> None:
        self._say = node.say
        self._heard_s = time.monotonic()
        self.pose: Pose | None = None
        """The newest pose, None before the first."""
        node.create_subscription(Odometry, ODOMETRY, self._hear, NEWEST_OF_ANY)

    @property
    def age_s(self) -> float:
        """Return the seconds since the newest pose, or since the start if there is none."""
        return time.monotonic() - self._heard_s

    def _hear(self, message: Odometry) -> None:
        place, turn = message.pose.pose.position, message.pose.pose.orientation
        pose = Pose(place.x, place.y, yaw_from_quaternion(turn.x, turn.y, turn.z, turn.w))
        if pose.is_finite:
            self.pose, self._heard_s = pose, time.monotonic()
        else:
            self._say.warn(_NO_NUMBER, every_s=1.0, topic=ODOMETRY)

"""Subscribes to a sensor, whether its driver is a reliable publisher, as in the course, or not.

A best-effort request would match both, but would then lose most large pictures, which travel in
many fragments, of a reliable publisher. So best effort is requested only if nothing else is
offered.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.qos import QoSPolicyKind, QoSProfile, ReliabilityPolicy

from nodes.parts.qos import DEPTH

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.event_handler import QoSRequestedIncompatibleQoSInfo
    from rclpy.subscription import Subscription

    from nodes.parts.node import LessonNode


class SensorListener:
    """Subscribes reliably, or as best effort from the first publisher on that offers no more."""

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

"""Message rates of topics, counted by the probe without decoding the messages."""

from __future__ import annotations

import importlib
import time
from collections import deque
from typing import TYPE_CHECKING, Any

from rclpy.qos import QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from rclpy.node import Node

KEPT = 50
"""Most messages between two checks; a camera sends one every 30 to 100 ms."""
COUNTED = 5
"""The rate is computed over this many recent messages."""


class _Counter:
    def __init__(self, node: Node, topic: str, kind: type[Any]) -> None:
        # This receives from reliable and best-effort publishers.
        quality = QoSProfile(depth=KEPT, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._subscription = node.create_subscription(
            kind, topic, lambda _message: None, quality, raw=True
        )
        self._stamps: deque[float] = deque(maxlen=COUNTED)

    def rate_hz(self) -> float:
        """Current messages per second; 0 until enough have arrived to compute it."""
        subscription = self._subscription
        while True:
            with subscription.handle:
                taken = subscription.handle.take_message(subscription.msg_type, subscription.raw)
            if taken is None:
                break
            self._stamps.append(taken[1]["received_timestamp"] / 1e9)
        if len(self._stamps) < COUNTED:
            return 0.0
        # A publisher that has fallen silent does not keep its former rate.
        lasted = max(self._stamps[-1], time.time() - self._period()) - self._stamps[0]
        return (COUNTED - 1) / lasted if lasted > 0 else 0.0

    def _period(self) -> float:
        return (self._stamps[-1] - self._stamps[0]) / (COUNTED - 1)


class MessageRates:
    """Counts the messages of each topic from the first request for it on."""

    def __init__(self, node: Node) -> None:
        """`node`: the node that subscribes."""
        self._node = node
        self._counters: dict[tuple[str, str], _Counter] = {}

    def rate_hz(self, topic: str, type_name: str) -> float | None:
        """Return messages per second, None if their type is not installed."""
        counter = self._counters.get((topic, type_name))
        if counter is None:
            package, _, name = type_name.partition("/msg/")
            try:
                kind = getattr(importlib.import_module(f"{package}.msg"), name)
            except (ImportError, AttributeError):
                return None
            counter = self._counters[topic, type_name] = _Counter(self._node, topic, kind)
        return counter.rate_hz()

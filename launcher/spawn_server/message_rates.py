"""How often messages of a topic come, counted by the probe without decoding them."""

from __future__ import annotations

import importlib
import time
from collections import deque
from typing import TYPE_CHECKING, Any

from rclpy.qos import QoSProfile, ReliabilityPolicy

if TYPE_CHECKING:
    from rclpy.node import Node

KEPT = 50
"""So many messages may come between two looks; one of a camera comes every 30 to 100 ms."""
COUNTED = 5
"""The rate is that of the last so many messages."""


class _Counter:
    def __init__(self, node: Node, topic: str, kind: type[Any]) -> None:
        # What is published reliably and what is not: this hears both.
        quality = QoSProfile(depth=KEPT, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._subscription = node.create_subscription(
            kind, topic, lambda _message: None, quality, raw=True
        )
        self._stamps: deque[float] = deque(maxlen=COUNTED)

    def rate_hz(self) -> float:
        """Messages per second now; 0 until there are as many as are counted."""
        subscription = self._subscription
        while True:
            with subscription.handle:
                taken = subscription.handle.take_message(subscription.msg_type, subscription.raw)
            if taken is None:
                break
            self._stamps.append(taken[1]["received_timestamp"] / 1e9)
        if len(self._stamps) < COUNTED:
            return 0.0
        # Who has fallen silent does not keep the rate that it had.
        lasted = max(self._stamps[-1], time.time() - self._period()) - self._stamps[0]
        return (COUNTED - 1) / lasted if lasted > 0 else 0.0

    def _period(self) -> float:
        return (self._stamps[-1] - self._stamps[0]) / (COUNTED - 1)


class MessageRates:
    """Counts the messages of a topic from the first request on."""

    def __init__(self, node: Node) -> None:
        """`node`: listens."""
        self._node = node
        self._counters: dict[tuple[str, str], _Counter] = {}

    def rate_hz(self, topic: str, type_name: str) -> float | None:
        """Return how often messages come, None where their type is not installed."""
        counter = self._counters.get((topic, type_name))
        if counter is None:
            package, _, name = type_name.partition("/msg/")
            try:
                kind = getattr(importlib.import_module(f"{package}.msg"), name)
            except (ImportError, AttributeError):
                return None
            counter = self._counters[topic, type_name] = _Counter(self._node, topic, kind)
        return counter.rate_hz()

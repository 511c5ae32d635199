"""Message rates of topics, counted by the probe without decoding the messages."""

from __future__ import annotations

import importlib
import time
from typing import TYPE_CHECKING, Any

from rclpy.qos import QoSProfile, ReliabilityPolicy

from launcher.spawn_server.arrival_rate import ArrivalRate

if TYPE_CHECKING:
    from rclpy.node import Node

KEPT = 50
"""Most messages between two checks; a camera sends one every 30 to 100 ms."""


class _Counter:
    def __init__(self, node: Node, topic: str, kind: type[Any]) -> None:
        # This receives from reliable and best-effort publishers.
        quality = QoSProfile(depth=KEPT, reliability=ReliabilityPolicy.BEST_EFFORT)
        self._subscription = node.create_subscription(kind, topic, lambda _message: None, quality, raw=True)
        self._rate = ArrivalRate()

    def rate_hz(self) -> float:
        """Current messages per second; 0 until enough have arrived to compute it."""
        subscription = self._subscription
        while True:
            with subscription.handle:
                taken = subscription.handle.take_message(subscription.msg_type, subscription.raw)
            if taken is None:
                break
            info = taken[1]
            self._rate.add(info["source_timestamp"] / 1e9, info["received_timestamp"] / 1e9)
        return self._rate.hz(time.time())


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

"""/diagnostics, where every driver reports its state: whether its device is there, and what it moves."""

from __future__ import annotations

import time
from collections.abc import Callable

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from nodes.parts.node import LessonNode
from robot.topics import DIAGNOSTICS

_EVERY_S = 1.0


def tell_every_second(node: LessonNode, status: Callable[[], DiagnosticStatus]) -> None:
    """Publish a status once a second from now on."""
    publisher = node.quick_publisher(DiagnosticArray, DIAGNOSTICS)

    def tell() -> None:
        message = DiagnosticArray(status=[status()])
        message.header.stamp = node.get_clock().now().to_msg()
        publisher.publish(message)

    node.every(_EVERY_S, tell)


class Rates:
    """What counters have gained per second since they were asked for last; from zero at the start."""

    def __init__(self) -> None:
        self._told_s = time.monotonic()
        self._told: tuple[int, ...] = ()

    def of(self, *counts: int) -> list[float]:
        now_s, told = time.monotonic(), self._told or (0,) * len(counts)
        passed_s = max(1e-3, now_s - self._told_s)
        self._told_s, self._told = now_s, counts
        # A restarted device counts its errors from zero.
        return [max(0, new - old) / passed_s for new, old in zip(counts, told, strict=True)]


def connection_status(
    name: str, state: tuple[bytes, str], port: str, since: str, seconds: float, connections: int, **more: str
) -> DiagnosticStatus:
    """Return the status of a device that comes and goes.

    `state` is level and sentence; `since`: ISO 8601, empty while it is away; `seconds`: since it came or went.
    """
    values = {
        "port": port,
        "connected": str(bool(since)).lower(),
        "connected_since": since,
        "seconds": f"{seconds:.1f}",
        "connections": str(connections),
        "reconnects": str(max(0, connections - 1)),
        **more,
    }
    pairs = [KeyValue(key=key, value=value) for key, value in values.items()]
    return DiagnosticStatus(level=state[0], message=state[1], name=name, hardware_id=port, values=pairs)

"""/diagnostics, where every driver reports its state."""

from __future__ import annotations

from collections.abc import Callable

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

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

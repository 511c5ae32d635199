"""Tells a node that moves nothing itself of each emergency stop, whichever node has heard it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Bool

from nodes.parts.qos import DEPTH
from nodes.parts.stop_reports import read_reports
from robot.safety.stop_record import StopRecord
from robot.topics import EMERGENCY_STATE, EMERGENCY_STOP

if TYPE_CHECKING:
    from collections.abc import Callable

    from nodes.parts.node import LessonNode

OF_MANY = QoSProfile(depth=64, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""Every node that obeys publishes its state, and all of them at once."""


class StopNews:
    """Hears the topic, and what those say that obey it: they may have heard what this node missed.

    What it broke off must not come back after the release.
    """

    def __init__(self, node: LessonNode, stopped: Callable[[], None]) -> None:
        """`stopped` is called for each stop, for some more than once."""
        self._stopped = stopped
        self._record: StopRecord | None = None
        node.create_subscription(Bool, EMERGENCY_STOP, self._hear, DEPTH)
        node.create_subscription(DiagnosticArray, EMERGENCY_STATE, self._hear_of, OF_MANY)

    def _hear(self, message: Bool) -> None:
        if message.data:
            self._stopped()

    def _hear_of(self, message: DiagnosticArray) -> None:
        for report in read_reports(message):
            if self._record is None:
                # What was released before the first word is none of this node's.
                self._record = StopRecord(released=report.record.released)
            known = self._record.held | self._record.released.keys()
            self._record = self._record.merged(report.record)
            # Also one that is over already.
            if (report.record.held | report.record.released.keys()) - known:
                self._stopped()

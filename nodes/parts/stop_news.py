"""Tells a node that moves nothing itself of each emergency stop, whichever node has heard it.

What it has heard itself it passes on by the disk: it may be the only one that has.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from diagnostic_msgs.msg import DiagnosticArray
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import Bool

from nodes.parts.qos import DEPTH
from nodes.parts.stop_reports import named, read_reports
from robot.safety.stop_file import NOT_PASSED, PASSED_EVERY_S, TOPIC, StopFile
from robot.safety.stop_record import Stop, StopRecord
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
        self._node, self._stopped = node, stopped
        self._record: StopRecord | None = None
        self._file = StopFile(node.context.get_domain_id(), node.get_fully_qualified_name())
        self._passed_s = 0.0
        self._waiting: Stop | None = None
        """The newest that was heard and not yet passed on."""
        node.every(PASSED_EVERY_S, self._pass_on)
        hear: Any = self._hear  # With what the middleware says, as in nodes.parts.emergency.
        node.create_subscription(Bool, EMERGENCY_STOP, hear, DEPTH)
        node.create_subscription(DiagnosticArray, EMERGENCY_STATE, self._hear_of, OF_MANY)

    def _hear(self, message: Bool, info: dict[str, Any]) -> None:
        if not message.data:
            return
        self._stopped()
        self._waiting = named(info)
        if time.monotonic() - self._passed_s > PASSED_EVERY_S:
            self._pass_on()

    def _pass_on(self) -> None:
        stop, self._waiting = self._waiting, None
        if stop is None:
            return
        self._passed_s = time.monotonic()
        problem = self._file.give(stop, TOPIC)
        if problem:
            self._node.say.error(NOT_PASSED, every_s=10.0, problem=problem)

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

"""The emergency stop as a node hears it: latched until it is released by an explicit false."""

from __future__ import annotations

from typing import TYPE_CHECKING

from std_msgs.msg import Bool

from nodes._topics import DEPTH, EMERGENCY_STOP, LATCHED

if TYPE_CHECKING:
    from collections.abc import Callable

    from nodes._node import LessonNode


class EmergencyStop:
    """Listens to /emergency_stop.

    Twice: the latched subscription learns of a stop that came before this node, but ROS does not
    match it with a volatile publisher, and `ros2 topic pub` is one. It must stop the robot too.
    What came before this node can only stop: of two publishers one may have released a stop long
    before the other gave the one that is on, and their words come in any order.
    """

    def __init__(self, node: LessonNode, changed: Callable[[bool], None]) -> None:
        self.active = False
        self._changed = changed
        node.create_subscription(Bool, EMERGENCY_STOP, self._hear_old, LATCHED)
        node.create_subscription(Bool, EMERGENCY_STOP, self._hear, DEPTH)

    def _hear_old(self, message: Bool) -> None:
        if message.data:
            self._hear(message)

    def _hear(self, message: Bool) -> None:
        if message.data != self.active:
            self.active = message.data
            self._changed(self.active)

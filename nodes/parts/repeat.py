"""Publishes the commands of words or a model on /drive: once, as in the course, or for a while.

A gate ignores old commands, so that the robot stops if their source has died. A node with single
commands then has to repeat them; a parameter sets how long one command moves the robot.
"""

from __future__ import annotations

import time

from ackermann_msgs.msg import AckermannDriveStamped

from nodes.parts.commands import LAST_STOP, to_message
from nodes.parts.emergency import EmergencyStopListener
from nodes.parts.node import DEPTH, LessonNode, Number
from robot.topics import DRIVE
from robot.words import STOP, DriveSetpoint
from text.i18n import N_

REPEAT_FOR_S = Number(
    0.0,
    "A command is sent 10 times a second for this long, then a stop; 0: it is sent once",
    fixed=True,
    high=60.0,
    unit="s",
)
_EVERY_S = 0.1
_OVER = N_("The command was repeated for {seconds:g} s: stop")


class DriveRepeater:
    """Publishes /drive for a node that has `REPEAT_FOR_S` among its settings."""

    def __init__(self, node: LessonNode) -> None:
        self._node, self._for_s = node, node.values["repeat_for_s"]
        self._publisher = node.create_publisher(AckermannDriveStamped, DRIVE, DEPTH)
        self._setpoint, self._until_s = STOP, 0.0
        if self._for_s:
            self._emergency = EmergencyStopListener(node, self._emergency_changed)
            self._timer = node.every(_EVERY_S, self._again)
            self._timer.cancel()

    def say(self, setpoint: DriveSetpoint) -> None:
        """Publish this command from now on, in place of the previous one."""
        self._publish(setpoint)
        if not self._for_s:
            return
        if setpoint == STOP or self._emergency.active:
            self._timer.cancel()
        else:
            self._until_s = time.monotonic() + self._for_s
            self._timer.reset()

    def hush(self) -> None:
        """Stop, if something is being repeated."""
        if self._for_s and not self._timer.is_canceled():
            self._timer.cancel()
            self._publish(STOP)

    def end(self) -> None:
        """Stop as `hush` does, and wait until that has arrived, as the node is about to end."""
        if self._for_s and not self._timer.is_canceled():
            self.hush()
            self._publisher.wait_for_all_acked(LAST_STOP)

    def _again(self) -> None:
        if time.monotonic() < self._until_s:
            self._publish(self._setpoint)
        else:
            self.hush()
            self._node.say.info(_OVER, seconds=self._for_s)

    def _emergency_changed(self, active: bool) -> None:
        if active:
            self.hush()

    def _publish(self, setpoint: DriveSetpoint) -> None:
        self._setpoint = setpoint
        self._publisher.publish(to_message(self._node, setpoint))

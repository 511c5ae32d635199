"""/odom as a node receives it: the robot's pose, its age, and its publisher."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from nav_msgs.msg import Odometry

from nodes.parts.qos import NEWEST_OF_ANY
from robot.motion.odometry import Pose, yaw_from_quaternion
from robot.topics import ODOMETRY
from text.i18n import N_

if TYPE_CHECKING:
    from nodes.parts.node import LessonNode

ODOM = "odom"
"""The frame of the poses on /odom (REP-105)."""
_NO_NUMBER = N_("{topic} is not a number and is ignored")


class OdometryListener:
    """Keeps the newest pose; one with nan or infinity is ignored."""

    def __init__(self, node: LessonNode) -> None:
        self._say = node.say
        self._heard_s = time.monotonic()
        self.pose: Pose | None = None
        """The newest pose, None before the first."""
        node.create_subscription(Odometry, ODOMETRY, self._hear, NEWEST_OF_ANY)

    @property
    def age_s(self) -> float:
        """Return the seconds since the newest pose, or since the start if there is none."""
        return time.monotonic() - self._heard_s

    def _hear(self, message: Odometry) -> None:
        place, turn = message.pose.pose.position, message.pose.pose.orientation
        pose = Pose(place.x, place.y, yaw_from_quaternion(turn.x, turn.y, turn.z, turn.w))
        if pose.is_finite:
            self.pose, self._heard_s = pose, time.monotonic()
        else:
            self._say.warn(_NO_NUMBER, every_s=1.0, topic=ODOMETRY)

"""/odom: the robot's pose as a node receives it, and as the base of a robot publishes it."""

from __future__ import annotations

import time

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Quaternion, TransformStamped
from nav_msgs.msg import Odometry
from std_msgs.msg import Header

from nodes.parts.commands import FRAME
from nodes.parts.node import NEWEST_OF_ANY, LessonNode
from robot.kinematics import turning_radius
from robot.motion.odometry import Pose, yaw_from_quaternion
from robot.topics import ODOMETRY
from robot.words import DriveSetpoint
from space.transform import quaternion_from_rpy
from text.i18n import N_

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


def turned(heading_rad: float) -> Quaternion:
    """Return the orientation of a robot on the floor."""
    x, y, z, w = quaternion_from_rpy(0.0, 0.0, heading_rad)
    return Quaternion(x=x, y=y, z=z, w=w)


def fill(message: Odometry, pose: Pose, motion: DriveSetpoint, wheelbase_m: float, stamp: Time) -> None:
    """Fill /odom, which may be published again and again: making it anew costs more than all the rest."""
    message.header, message.child_frame_id = Header(stamp=stamp, frame_id=ODOM), FRAME
    message.pose.pose.position.x, message.pose.pose.position.y = pose.x_m, pose.y_m
    message.pose.pose.orientation = turned(pose.heading_rad)
    message.twist.twist.linear.x = motion.speed_m_s
    message.twist.twist.angular.z = motion.speed_m_s / turning_radius(motion.steering_rad, wheelbase_m)


def transform_to(pose: Pose, stamp: Time) -> TransformStamped:
    """Return /tf: odom to base_link."""
    message = TransformStamped(header=Header(stamp=stamp, frame_id=ODOM), child_frame_id=FRAME)
    message.transform.translation.x, message.transform.translation.y = pose.x_m, pose.y_m
    message.transform.rotation = turned(pose.heading_rad)
    return message

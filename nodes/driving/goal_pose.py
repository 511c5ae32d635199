"""/goal_pose: the point that `drive_to_point` drives to, for drawing it on a map."""

from __future__ import annotations

from typing import TYPE_CHECKING

from geometry_msgs.msg import PoseStamped

from nodes.parts.odometry import ODOM
from nodes.parts.qos import LATCHED
from robot.topics import GOAL_POSE

if TYPE_CHECKING:
    from nodes.parts.node import LessonNode
    from robot.motion.odometry import Point


class GoalPose:
    """Publishes one goal at a time; a pose without a frame means that there is none."""

    def __init__(self, node: LessonNode) -> None:
        self._node = node
        self._publisher = node.create_publisher(PoseStamped, GOAL_POSE, LATCHED)

    def tell(self, point: Point) -> None:
        """Publish a new goal point; the robot may arrive with any heading."""
        message = self._message()
        message.header.frame_id = ODOM
        message.pose.position.x, message.pose.position.y = point.x_m, point.y_m
        self._publisher.publish(message)

    def forget(self) -> None:
        """Publish that there is no goal any more."""
        self._publisher.publish(self._message())

    def _message(self) -> PoseStamped:
        message = PoseStamped()
        message.header.stamp = self._node.get_clock().now().to_msg()
        message.pose.orientation.w = 1.0
        return message

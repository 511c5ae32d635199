"""/drive messages to setpoints and back."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ackermann_msgs.msg import AckermannDriveStamped

from robot.words import DriveSetpoint

if TYPE_CHECKING:
    from nodes.parts.node import LessonNode

FRAME = "base_link"


def to_message(node: LessonNode, setpoint: DriveSetpoint) -> AckermannDriveStamped:
    """Build a message stamped now."""
    message = AckermannDriveStamped()
    message.header.stamp = node.get_clock().now().to_msg()
    message.header.frame_id = FRAME
    message.drive.speed = float(setpoint.speed_m_s)
    message.drive.steering_angle = float(setpoint.steering_rad)
    return message


def from_message(message: AckermannDriveStamped) -> DriveSetpoint:
    """Return its command; values are taken unchanged, nan included."""
    return DriveSetpoint(message.drive.speed, message.drive.steering_angle)

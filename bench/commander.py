"""A commander: publishes 0.3 m/s ahead on /drive, 10 times per second, until SIGINT."""

from __future__ import annotations

import contextlib

import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from rclpy.executors import ExternalShutdownException


def main() -> None:
    """Publish commands until interrupted."""
    rclpy.init()
    node = rclpy.create_node("commander")
    publisher = node.create_publisher(AckermannDriveStamped, "/drive", 10)
    message = AckermannDriveStamped()
    message.drive.speed = 0.3

    def command() -> None:
        message.header.stamp = node.get_clock().now().to_msg()
        publisher.publish(message)

    node.create_timer(0.1, command)
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)


if __name__ == "__main__":
    main()

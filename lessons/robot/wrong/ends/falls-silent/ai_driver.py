import time

import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

MOTIONS = {
    "вперед": (0.5, 0.0),
    "налево": (0.3, 0.5),
    "направо": (0.3, -0.5),
    "назад": (-0.3, 0.0),
    "стоп": (0.0, 0.0),
}
"""A word to its speed in m/s and steering angle in rad."""


class AiDriver(Node):
    def __init__(self):
        super().__init__("ai_driver")
        self.wanted = None
        self.until = 0.0
        self.publisher = self.create_publisher(AckermannDriveStamped, "/drive", 10)
        self.create_subscription(String, "/ai_command", self.on_command, 10)
        self.create_timer(0.1, self.repeat)

    def on_command(self, message):
        motion = MOTIONS.get(message.data)
        if motion is None:
            self.get_logger().warning(f"unknown command: {message.data}")
            return
        self.wanted = motion
        self.until = time.monotonic() + 2.0

    def repeat(self):
        if self.wanted is None:
            return
        if time.monotonic() < self.until:
            self.publish(*self.wanted)
        else:
            self.wanted = None

    def publish(self, speed, steering):
        message = AckermannDriveStamped()
        message.header.stamp = self.get_clock().now().to_msg()
        message.drive.speed = speed
        message.drive.steering_angle = steering
        self.publisher.publish(message)


def main(args=None):
    rclpy.init(args=args)
    node = AiDriver()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

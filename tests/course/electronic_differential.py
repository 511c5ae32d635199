"""As in the course."""

import math

import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from rclpy.node import Node


class ElectronicDifferential(Node):
    """Writes the speeds of the wheels into its log; no topic has them."""

    def __init__(self) -> None:
        super().__init__("electronic_differential")
        self.create_subscription(AckermannDriveStamped, "/drive", self.share, 10)

    def share(self, message: AckermannDriveStamped) -> None:
        speed, angle = message.drive.speed, message.drive.steering_angle
        inner = 0.0 if abs(angle) < 0.01 else 0.15 * math.tan(angle) / (2 * 0.25)
        self.get_logger().info(f"left {speed * (1 - inner):.2f}, right {speed * (1 + inner):.2f}")


def main() -> None:
    rclpy.init()
    node = ElectronicDifferential()
    node.get_logger().info("started")
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.shutdown()


if __name__ == "__main__":
    main()

"""As in the course."""

import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from rclpy.node import Node
from std_msgs.msg import String

DRIVES = {
    "вперед": (0.5, 0.0),
    "налево": (0.3, 0.5),
    "направо": (0.3, -0.5),
    "назад": (-0.3, 0.0),
    "стоп": (0.0, 0.0),
}


class AiDriver(Node):
    """Words to drives, each said once and without a stamp."""

    def __init__(self) -> None:
        super().__init__("ai_driver_translator")
        self.create_subscription(String, "/ai_command", self.translate, 10)
        self.publisher = self.create_publisher(AckermannDriveStamped, "/drive", 10)

    def translate(self, message: String) -> None:
        drive = DRIVES.get(message.data.lower())
        if drive is None:
            self.get_logger().warning(f"unknown: {message.data}")
            return
        out = AckermannDriveStamped()
        out.drive.speed, out.drive.steering_angle = drive
        self.publisher.publish(out)


def main() -> None:
    rclpy.init()
    node = AiDriver()
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

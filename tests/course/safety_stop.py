"""As in the course."""

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float32


class SafetyStop(Node):
    """Warns of what is near, and does no more: it lets nothing through and stops nothing."""

    def __init__(self) -> None:
        super().__init__("safety_node")
        self.create_subscription(Float32, "/sensor/sonar_front", self.judge, 10)

    def judge(self, message: Float32) -> None:
        if message.data < 0.5:
            self.get_logger().warning(f"near: {message.data:.2f} m")
        else:
            self.get_logger().info(f"far: {message.data:.2f} m")


def main() -> None:
    rclpy.init()
    node = SafetyStop()
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

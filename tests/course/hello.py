"""As in the course."""

import rclpy
from rclpy.node import Node


class Hello(Node):
    """Counts the seconds in its log."""

    def __init__(self) -> None:
        super().__init__("hello_node")
        self.count = 0
        self.create_timer(1.0, self.count_on)

    def count_on(self) -> None:
        self.count += 1
        self.get_logger().info(f"second {self.count}")


def main() -> None:
    rclpy.init()
    node = Hello()
    node.get_logger().info("started")
    rclpy.spin(node)
    rclpy.shutdown()


if __name__ == "__main__":
    main()

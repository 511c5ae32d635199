"""As in the course."""

import random

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float32


class MockSonar(Node):
    """Says a distance once a second."""

    def __init__(self) -> None:
        super().__init__("mock_sonar_front")
        self.publisher = self.create_publisher(Float32, "/sensor/sonar_front", 10)
        self.create_timer(1.0, self.measure)

    def measure(self) -> None:
        self.publisher.publish(Float32(data=random.uniform(0.2, 3.0)))


def main() -> None:
    rclpy.init()
    node = MockSonar()
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

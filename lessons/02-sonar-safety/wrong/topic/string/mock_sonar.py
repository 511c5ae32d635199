import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class MockSonar(Node):
    def __init__(self):
        super().__init__("mock_sonar")
        self.publisher = self.create_publisher(String, "/sensor/sonar_front", 10)
        self.create_timer(1.0, self.measure)
        self.get_logger().info("the sonar is on")

    def measure(self):
        message = String()
        message.data = str(random.uniform(0.2, 3.0))
        self.publisher.publish(message)
        self.get_logger().info(f"distance {message.data} m")


def main(args=None):
    rclpy.init(args=args)
    node = MockSonar()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

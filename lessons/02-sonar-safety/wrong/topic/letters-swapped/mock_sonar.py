import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float32


class MockSonar(Node):
    def __init__(self):
        super().__init__("mock_sonar")
        self.publisher = self.create_publisher(Float32, "/sensor/sonar_fornt", 10)
        self.create_timer(1.0, self.measure)
        self.get_logger().info("the sonar is on")

    def measure(self):
        message = Float32()
        message.data = random.uniform(0.2, 3.0)
        self.publisher.publish(message)
        self.get_logger().info(f"distance {message.data:.3f} m")


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

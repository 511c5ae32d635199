import random

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Float32


class MockSonar(Node):
    def __init__(self):
        super().__init__("mock_sonar")
        # MISSING: a publisher of Float32 on /sensor/sonar_front, in self.publisher.
        # НЕ ХВАТАЕТ: издателя Float32 в топике /sensor/sonar_front, в self.publisher.
        # MISSING: a timer that calls self.measure once a second.
        # НЕ ХВАТАЕТ: таймера, который раз в секунду вызывает self.measure.
        self.get_logger().info("the sonar is on")  # ru: "сонар включён"

    def measure(self):
        # MISSING: a Float32 with a random distance from 0.2 to 3.0 m, published.
        # НЕ ХВАТАЕТ: Float32 со случайным расстоянием от 0.2 до 3.0 м и его публикации.
        pass


def main(args=None):
    rclpy.init(args=args)
    node = MockSonar()
    # MISSING: catch Ctrl-C around spin, and end without an error.
    # НЕ ХВАТАЕТ: перехватить Ctrl-C вокруг spin и завершиться без ошибки.
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()

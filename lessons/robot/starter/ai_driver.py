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
        # MISSING: a timer that calls self.repeat ten times a second.
        # НЕ ХВАТАЕТ: таймера, который вызывает self.repeat десять раз в секунду.

    def on_command(self, message):
        # MISSING: what is wanted, of MOTIONS, in self.wanted; until when, time.monotonic() + 2.0.
        # НЕ ХВАТАЕТ: желаемого из MOTIONS в self.wanted; срока time.monotonic() + 2.0 в self.until.
        pass

    def repeat(self):
        # MISSING: while there is time, publish what is wanted; after that a stop, once.
        # НЕ ХВАТАЕТ: пока срок не вышел, публиковать желаемое; потом один раз — стоп.
        pass

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

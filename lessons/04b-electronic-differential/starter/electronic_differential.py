import math

import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import JointState


class ElectronicDifferential(Node):
    def __init__(self):
        super().__init__("electronic_differential")
        # MISSING: a publisher of JointState on /wheel_commands, in self.publisher.
        # НЕ ХВАТАЕТ: издателя JointState в топике /wheel_commands, в self.publisher.
        # MISSING: a subscription to /drive that calls self.on_drive.
        # НЕ ХВАТАЕТ: подписки на /drive, которая вызывает self.on_drive.
        # MISSING: the parameters "wheelbase" (0.25 by default) and "track" (0.15).
        # НЕ ХВАТАЕТ: параметров "wheelbase" (по умолчанию 0.25) и "track" (0.15).
        # MISSING (last step): a timer of 0.5 s, in self.watchdog, that calls self.on_silence.
        # НЕ ХВАТАЕТ (последний шаг): таймера 0.5 с в self.watchdog, вызывающего self.on_silence.
        self.get_logger().info("the differential waits for /drive")  # ru: "дифференциал ждёт /drive"

    def on_drive(self, message):
        # MISSING: the speed of each wheel, by the formulas; then self.tell(left, right).
        # НЕ ХВАТАЕТ: скорости каждого колеса по формулам; затем self.tell(left, right).
        # MISSING (last step): reset the watchdog.
        # НЕ ХВАТАЕТ (последний шаг): сбросить таймер watchdog.
        pass

    def on_silence(self):
        # MISSING (last step): stop both wheels.
        # НЕ ХВАТАЕТ (последний шаг): остановить оба колеса.
        pass

    def tell(self, left, right):
        """Publish the speeds of the wheels. Опубликовать скорости колёс."""
        message = JointState()
        message.header.stamp = self.get_clock().now().to_msg()
        message.name = ["rear_left_wheel_joint", "rear_right_wheel_joint"]
        message.velocity = [left, right]
        self.publisher.publish(message)


def main(args=None):
    rclpy.init(args=args)
    node = ElectronicDifferential()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

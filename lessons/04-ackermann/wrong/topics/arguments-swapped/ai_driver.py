import math

import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String

ENGLISH = {
    "вперед": "forward",
    "вперёд": "forward",
    "назад": "back",
    "налево": "left",
    "направо": "right",
    "стоп": "stop",
}


class AiDriver(Node):
    def __init__(self):
        super().__init__("ai_driver")
        self.publisher = self.create_publisher(AckermannDriveStamped, "/drive", 10)
        self.create_subscription("/ai_command", String, self.on_command, 10)
        self.get_logger().info("I translate words into motion")

    def on_command(self, message):
        # "Налево 20" becomes word = "left", number = "20"; "Налево" has no number: None.
        # Из «Налево 20» получается word = "left", number = "20"; в «Налево» числа нет: None.
        word, number = [*message.data.lower().split(), None, None][:2]
        word = ENGLISH.get(word, word)

        drive = AckermannDriveStamped()
        drive.header.stamp = self.get_clock().now().to_msg()
        angle = 0.5 if number is None else math.radians(float(number))
        if word == "forward":
            drive.drive.speed = 0.5
        elif word == "back":
            drive.drive.speed = -0.3
        elif word == "left":
            drive.drive.speed = 0.3
            drive.drive.steering_angle = angle
        elif word == "right":
            drive.drive.speed = 0.3
            drive.drive.steering_angle = -angle
        elif word == "stop":
            drive.drive.speed = 0.0
        else:
            self.get_logger().warning(f"unknown command: {message.data}")
            return
        self.publisher.publish(drive)
        self.get_logger().info(f"{word}: {drive.drive.speed} m/s")


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

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
        # MISSING: a publisher of AckermannDriveStamped on /drive, in self.publisher.
        # НЕ ХВАТАЕТ: издателя AckermannDriveStamped в топике /drive, в self.publisher.
        # MISSING: a subscription to String on /ai_command that calls self.on_command.
        # НЕ ХВАТАЕТ: подписки на String в /ai_command, которая вызывает self.on_command.
        self.get_logger().info("I translate words into motion")  # ru: "перевожу слова в движение"

    def on_command(self, message):
        # "Налево 20" becomes word = "left", number = "20"; "Налево" has no number: None.
        # Из «Налево 20» получается word = "left", number = "20"; в «Налево» числа нет: None.
        word, number = [*message.data.lower().split(), None, None][:2]
        word = ENGLISH.get(word, word)

        drive = AckermannDriveStamped()
        drive.header.stamp = self.get_clock().now().to_msg()
        # MISSING: drive.drive.speed and drive.drive.steering_angle for each word.
        # НЕ ХВАТАЕТ: drive.drive.speed и drive.drive.steering_angle для каждого слова.
        # MISSING: for an unknown word, a warning, and return.
        # НЕ ХВАТАЕТ: для незнакомого слова — предупреждения и return.
        # MISSING: publish drive.
        # НЕ ХВАТАЕТ: публикации drive.


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

import math

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import ByteMultiArray, Float32, String


class AiBrain(Node):
    def __init__(self):
        super().__init__("ai_brain")
        self.distance = math.nan
        self.command = self.create_publisher(String, "/ai_command", 10)
        self.create_subscription(ByteMultiArray, "/audio/mic_raw", self.on_voice, 10)
        self.create_subscription(Float32, "/sensor/sonar_front", self.on_distance, 10)

    def on_distance(self, message):
        self.distance = message.data

    def on_voice(self, message):
        # MISSING: the text of the bytes in the log, then a word on /ai_command:
        # "вперед" if the distance is 1.0 m or more, otherwise (nan, too) "стоп".
        # НЕ ХВАТАЕТ: текста из байтов в журнале, затем слова в /ai_command:
        # "вперед", если расстояние не меньше 1.0 м, иначе (и при nan) "стоп".
        pass


def main(args=None):
    rclpy.init(args=args)
    node = AiBrain()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

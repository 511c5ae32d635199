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
        text = b"".join(message.data).decode("utf-8", errors="replace")
        self.get_logger().info(f"heard: {text}")
        word = "вперед" if self.distance >= 1.0 else "стоп"
        self.command.publish(String(data=word))


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

"""As in the course."""

import rclpy
from rclpy.node import Node
from std_msgs.msg import ByteMultiArray


class MockAudio(Node):
    """Says a phrase into the microphone, and writes down what the speaker is given."""

    def __init__(self) -> None:
        super().__init__("audio_system")
        self.microphone = self.create_publisher(ByteMultiArray, "/audio/mic_raw", 10)
        self.create_subscription(ByteMultiArray, "/audio/speaker_raw", self.play, 10)
        self.create_timer(10.0, self.speak)

    def speak(self) -> None:
        message = ByteMultiArray()
        message.data = b"VOICE_COMMAND: Look around and tell me what you see!"
        self.microphone.publish(message)

    def play(self, message: ByteMultiArray) -> None:
        words = b"".join(message.data).decode("utf-8", errors="ignore")
        self.get_logger().info(f"the speaker says: {words}")


def main() -> None:
    rclpy.init()
    node = MockAudio()
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

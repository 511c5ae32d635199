"""As in the course."""

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node
from sensor_msgs.msg import Image
from std_msgs.msg import ByteMultiArray, Float32, String


class AiBrain(Node):
    """Answers each phrase by the distance: a voice, a word to drive by, a turn of the head."""

    def __init__(self) -> None:
        super().__init__("ai_brain")
        self.distance_m = 999.0
        self.create_subscription(Image, "/camera/color/image_raw", lambda _: None, 10)
        self.create_subscription(ByteMultiArray, "/audio/mic_raw", self.answer, 10)
        self.create_subscription(Float32, "/sensor/sonar_front", self.see, 10)
        self.word = self.create_publisher(String, "/ai_command", 10)
        self.speaker = self.create_publisher(ByteMultiArray, "/audio/speaker_raw", 10)
        self.head = self.create_client(AddTwoInts, "set_head_position")

    def see(self, message: Float32) -> None:
        self.distance_m = message.data

    def answer(self, message: ByteMultiArray) -> None:
        heard = b"".join(message.data).decode("utf-8")
        self.get_logger().info(f"heard {heard}")
        near = self.distance_m < 1.0
        if not near and self.head.wait_for_service(timeout_sec=1.0):
            self.head.call_async(AddTwoInts.Request(a=45, b=0))
        words = b"I stopped" if near else b"Moving forward"
        voice = ByteMultiArray()
        voice.data = words
        self.speaker.publish(voice)
        self.word.publish(String(data="стоп" if near else "вперед"))


def main() -> None:
    rclpy.init()
    node = AiBrain()
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

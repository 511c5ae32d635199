import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import ByteMultiArray


class MockAudio(Node):
    def __init__(self):
        super().__init__("audio_system")
        self.declare_parameter("period", 10.0)
        self.declare_parameter("phrase", "VOICE_COMMAND: Робот, что ты видишь?")
        self.microphone = self.create_publisher(ByteMultiArray, "/audio/mic_raw", 10)
        self.create_subscription(ByteMultiArray, "/audio/speaker_raw", self.play, 10)
        self.create_timer(self.get_parameter("period").value, self.speak)
        self.get_logger().info("microphone and speaker are on")

    def speak(self):
        sound = self.get_parameter("phrase").value.encode("utf-8")
        message = ByteMultiArray()
        message.data = [sound[i : i + 1] for i in range(len(sound))]
        self.microphone.publish(message)
        self.get_logger().info("somebody speaks into the microphone")

    def play(self, message):
        text = b"".join(message.data).decode("ascii", errors="ignore")
        self.get_logger().info(f"the speaker plays: {text}")


def main(args=None):
    rclpy.init(args=args)
    node = MockAudio()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

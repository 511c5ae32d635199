import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import ByteMultiArray


class MockAudio(Node):
    def __init__(self):
        super().__init__("audio_system")
        self.declare_parameter("period", 10.0)
        self.declare_parameter("phrase", "VOICE_COMMAND: Робот, что ты видишь?")
        # MISSING: a publisher of ByteMultiArray on /audio/mic_raw, in self.microphone.
        # НЕ ХВАТАЕТ: издателя ByteMultiArray в топике /audio/mic_raw, в self.microphone.
        # MISSING: a subscription to /audio/speaker_raw that calls self.play.
        # НЕ ХВАТАЕТ: подписки на /audio/speaker_raw, которая вызывает self.play.
        # MISSING: a timer that calls self.speak every `period` seconds (the parameter).
        # НЕ ХВАТАЕТ: таймера, который раз в `period` секунд (параметр) вызывает self.speak.
        self.get_logger().info("microphone and speaker are on")  # ru: "микрофон и динамик включены"

    def speak(self):
        # MISSING: the parameter `phrase` as bytes, in a ByteMultiArray, published.
        # НЕ ХВАТАЕТ: параметра `phrase` в виде байтов, в ByteMultiArray, и публикации.
        pass

    def play(self, message):
        # MISSING: the bytes joined, decoded as UTF-8 (noise must not raise), and logged.
        # НЕ ХВАТАЕТ: соединить байты, раскодировать UTF-8 (шум не мешает), в журнал.
        pass


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

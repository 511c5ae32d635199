import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import Image
from std_msgs.msg import ByteMultiArray, Float32, String


class AiBrain(Node):
    def __init__(self):
        super().__init__("ai_brain")
        self.distance = 999.0
        self.picture = None
        self.create_subscription(ByteMultiArray, "/audio/mic_raw", self.on_voice, 10)
        self.create_subscription(Float32, "/sensor/sonar_front", self.on_distance, 10)
        self.create_subscription(Image, "/camera/color/image_raw", self.on_picture, 10)
        self.command = self.create_publisher(String, "/ai_command", 10)
        self.speaker = self.create_publisher(ByteMultiArray, "/audio/speaker_raw", 10)
        self.drive = self.create_publisher(AckermannDriveStamped, "/drive", 10)
        self.head = self.create_client(AddTwoInts, "set_head_position")
        self.get_logger().info("the brain is awake")

    def on_picture(self, message):
        self.picture = message

    def on_distance(self, message):
        self.distance = message.data

    def on_voice(self, message):
        text = b"".join(message.data).decode("utf-8", errors="replace")
        self.get_logger().info(f"heard: {text}")
        self.think()

    def think(self):
        if self.distance < 1.0:
            self.command.publish(String(data="стоп"))
            self.say_aloud("There is something in front of me, I stand still.")
        else:
            self.turn_head(45, 0)
            self.command.publish(String(data="вперед"))
            self.say_aloud("The path is clear, I look round and drive.")

    def say_aloud(self, text):
        sound = text.encode("utf-8")
        message = ByteMultiArray()
        message.data = [sound[i : i + 1] for i in range(len(sound))]
        self.speaker.publish(message)

    def turn_head(self, pan, tilt):
        self.head.call_async(AddTwoInts.Request(a=pan, b=tilt))


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

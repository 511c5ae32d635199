import rclpy
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
        # MISSING: subscriptions to /audio/mic_raw (self.on_voice), /sensor/sonar_front
        # (self.on_distance) and /camera/color/image_raw (self.on_picture).
        # НЕ ХВАТАЕТ: подписок на /audio/mic_raw (self.on_voice), /sensor/sonar_front
        # (self.on_distance) и /camera/color/image_raw (self.on_picture).
        # MISSING: publishers of String on /ai_command, in self.command, and of ByteMultiArray
        # on /audio/speaker_raw, in self.speaker.
        # НЕ ХВАТАЕТ: издателей String в /ai_command, в self.command, и ByteMultiArray
        # в /audio/speaker_raw, в self.speaker.
        # MISSING: a client of set_head_position (AddTwoInts), in self.head.
        # НЕ ХВАТАЕТ: клиента set_head_position (AddTwoInts), в self.head.
        self.get_logger().info("the brain is awake")  # ru: "мозг проснулся"

    def on_picture(self, message):
        self.picture = message

    def on_distance(self, message):
        # MISSING: keep the distance in self.distance.
        # НЕ ХВАТАЕТ: запомнить расстояние в self.distance.
        pass

    def on_voice(self, message):
        # MISSING: the text of the bytes in the log, then self.think().
        # НЕ ХВАТАЕТ: текста из байтов в журнале, затем self.think().
        pass

    def think(self):
        # MISSING: nearer than 1.0 m: "стоп" and an answer aloud;
        # otherwise self.turn_head(45, 0), "вперед" and an answer aloud.
        # НЕ ХВАТАЕТ: ближе 1.0 м: "стоп" и ответ вслух;
        # иначе self.turn_head(45, 0), "вперед" и ответ вслух.
        pass

    def say_aloud(self, text):
        sound = text.encode("utf-8")
        message = ByteMultiArray()
        message.data = [sound[i : i + 1] for i in range(len(sound))]
        self.speaker.publish(message)

    def turn_head(self, pan, tilt):
        # MISSING: a request with a=pan, b=tilt, sent without waiting for the answer.
        # НЕ ХВАТАЕТ: запроса с a=pan, b=tilt, отправленного без ожидания ответа.
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

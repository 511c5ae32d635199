"""As in the course."""

import json

import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node
from std_msgs.msg import String


class LlmParser(Node):
    """Carries out a checked JSON at once, without a stamp, and tells nobody what came of it."""

    def __init__(self) -> None:
        super().__init__("llm_parser")
        self.create_subscription(String, "/llm_raw_json", self.execute, 10)
        self.drive = self.create_publisher(AckermannDriveStamped, "/drive", 10)
        self.head = self.create_client(AddTwoInts, "set_head_position")

    def execute(self, message: String) -> None:
        for command in json.loads(message.data)["commands"]:
            if command["action"] == "drive":
                out = AckermannDriveStamped()
                out.drive.speed = float(command["speed"])
                out.drive.steering_angle = float(command["steering"])
                self.drive.publish(out)
            elif self.head.wait_for_service(timeout_sec=0.2):
                self.head.call_async(AddTwoInts.Request(a=command["pan"], b=command["tilt"]))


def main() -> None:
    rclpy.init()
    node = LlmParser()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

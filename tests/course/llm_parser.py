"""As in the course."""

from typing import Literal

import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from example_interfaces.srv import AddTwoInts
from pydantic import BaseModel, ValidationError
from rclpy.node import Node
from std_msgs.msg import String


class Drive(BaseModel):
    """A movement: metres a second, and radians."""

    action: Literal["drive"]
    speed: float
    steering: float


class Head(BaseModel):
    """A turn of the head, in degrees."""

    action: Literal["turn_head"]
    pan: int
    tilt: int


class Answer(BaseModel):
    """What the model says."""

    thought: str
    commands: list[Drive | Head]


class LlmParser(Node):
    """Carries out a checked JSON at once, without a stamp, and tells nobody what came of it."""

    def __init__(self) -> None:
        super().__init__("llm_parser")
        self.create_subscription(String, "/llm_raw_json", self.execute, 10)
        self.drive = self.create_publisher(AckermannDriveStamped, "/drive", 10)
        self.head = self.create_client(AddTwoInts, "set_head_position")

    def execute(self, message: String) -> None:
        try:
            answer = Answer.model_validate_json(message.data)
        except ValidationError as error:
            self.get_logger().error(f"no such answer: {error}")
            return
        for command in answer.commands:
            if isinstance(command, Drive):
                out = AckermannDriveStamped()
                out.drive.speed = command.speed
                out.drive.steering_angle = command.steering
                self.drive.publish(out)
            elif self.head.wait_for_service(timeout_sec=0.2):
                self.head.call_async(AddTwoInts.Request(a=command.pan, b=command.tilt))


def main() -> None:
    rclpy.init()
    node = LlmParser()
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

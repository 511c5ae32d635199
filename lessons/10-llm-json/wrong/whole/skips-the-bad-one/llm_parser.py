from typing import Literal

import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from example_interfaces.srv import AddTwoInts
from pydantic import BaseModel, Field, ValidationError
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class DriveCommand(BaseModel):
    action: Literal["drive"]
    speed: float = Field(ge=-0.5, le=0.5)
    steering: float = Field(ge=-0.5, le=0.5)


class HeadCommand(BaseModel):
    action: Literal["turn_head"]
    pan: int = Field(ge=-90, le=90)
    tilt: int = Field(ge=-90, le=90)


class LlmResponse(BaseModel):
    thought: str
    commands: list[dict]


class LlmParser(Node):
    def __init__(self):
        super().__init__("llm_parser")
        self.create_subscription(String, "/llm_raw_json", self.on_json, 10)
        self.publisher = self.create_publisher(AckermannDriveStamped, "/drive", 10)
        self.head = self.create_client(AddTwoInts, "set_head_position")
        self.get_logger().info("waiting for JSON of the model")

    def on_json(self, message):
        try:
            response = LlmResponse.model_validate_json(message.data)
        except ValidationError as error:
            self.get_logger().error(f"the answer is refused: {error}")
            return
        self.get_logger().info(f"the model thinks: {response.thought}")
        for command in response.commands:
            try:
                kind = DriveCommand if command.get("action") == "drive" else HeadCommand
                command = kind.model_validate(command)
            except ValidationError as error:
                self.get_logger().error(f"skipped: {error}")
                continue
            if command.action == "drive":
                self.drive(command)
            else:
                self.turn_head(command)

    def drive(self, command):
        message = AckermannDriveStamped()
        message.drive.speed = command.speed
        message.drive.steering_angle = command.steering
        self.publisher.publish(message)

    def turn_head(self, command):
        self.head.call_async(AddTwoInts.Request(a=command.pan, b=command.tilt))


def main(args=None):
    rclpy.init(args=args)
    node = LlmParser()
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

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
    # MISSING: the limits of both numbers, with Field(ge=..., le=...).
    # НЕ ХВАТАЕТ: пределов обоих чисел, через Field(ge=..., le=...).
    speed: float
    steering: float


class HeadCommand(BaseModel):
    action: Literal["turn_head"]
    # MISSING: the limits of both angles.
    # НЕ ХВАТАЕТ: пределов обоих углов.
    pan: int
    tilt: int


class LlmResponse(BaseModel):
    thought: str
    commands: list[DriveCommand | HeadCommand]


class LlmParser(Node):
    def __init__(self):
        super().__init__("llm_parser")
        # MISSING: a subscription to /llm_raw_json (String) that calls self.on_json.
        # НЕ ХВАТАЕТ: подписки на /llm_raw_json (String), которая вызывает self.on_json.
        # MISSING: a publisher of AckermannDriveStamped on /drive, in self.publisher.
        # НЕ ХВАТАЕТ: издателя AckermannDriveStamped в топике /drive, в self.publisher.
        # MISSING: a client of set_head_position (AddTwoInts), in self.head.
        # НЕ ХВАТАЕТ: клиента set_head_position (AddTwoInts), в self.head.
        self.get_logger().info("waiting for JSON of the model")  # ru: "жду JSON от модели"

    def on_json(self, message):
        # MISSING: make an LlmResponse of message.data; log an error if it is refused.
        # НЕ ХВАТАЕТ: сделать LlmResponse из message.data; при отказе записать ошибку в журнал.
        # MISSING: log the thought, and carry out each command in order.
        # НЕ ХВАТАЕТ: записать мысль в журнал и выполнить команды по порядку.
        pass

    def drive(self, command):
        # MISSING: an AckermannDriveStamped with speed and steering_angle, published.
        # НЕ ХВАТАЕТ: AckermannDriveStamped с speed и steering_angle и его публикации.
        pass

    def turn_head(self, command):
        # MISSING: a request with a=pan, b=tilt, sent without waiting for the answer.
        # НЕ ХВАТАЕТ: запроса с a=pan, b=tilt, отправленного без ожидания ответа.
        pass


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

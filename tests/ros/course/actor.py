"""A node that does a bit of everything, some of it wrong, for the judge to look at."""

from __future__ import annotations

from typing import Any

import rclpy
from deck_interfaces.action import DriveToPoint
from example_interfaces.srv import AddTwoInts
from rcl_interfaces.msg import SetParametersResult
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image
from std_msgs.msg import Float32, String

PERIOD_S = 0.1
HASTY = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class Actor(Node):
    """Publishes, answers, drives and remembers."""

    def __init__(self) -> None:
        super().__init__("actor")
        self.count = self.asked = self.told = 0
        self.declare_parameter("limit", 0.5)
        self.declare_parameter("loose", 1)
        self.add_on_set_parameters_callback(self.on_set)
        self.numbers = self.create_publisher(Float32, "/count", 10)
        self.same = self.create_publisher(Float32, "/same", HASTY)
        self.near = self.create_publisher(Float32, "/near", 10)
        self.image = self.create_publisher(Image, "/image", 10)
        self.still = self.create_publisher(Image, "/still", 10)
        self.answer = self.create_publisher(String, "/answer", 10)
        self.create_subscription(String, "/ask", self.on_ask, 10)
        self.second = self.create_publisher(String, "/second", 10)
        self.create_subscription(String, "/ask_twice", self.on_ask_twice, 10)
        self.among = self.create_publisher(String, "/among", 10)
        self.echo = self.create_publisher(String, "/echo", 10)
        self.create_subscription(String, "/among", self.on_among, 10)
        self.create_service(AddTwoInts, "/add", self.on_add)
        self.action = ActionServer(
            self,
            DriveToPoint,
            "/drive_to",
            self.on_goal,
            goal_callback=lambda goal: GoalResponse.ACCEPT if goal.x >= 0 else GoalResponse.REJECT,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
            callback_group=ReentrantCallbackGroup(),
        )
        self.create_timer(PERIOD_S, self.tick)
        self.get_logger().info("the actor is there")  # type: ignore[no-untyped-call]

    def tick(self) -> None:
        self.count += 1
        self.numbers.publish(Float32(data=float(self.count)))
        self.same.publish(Float32(data=1.0))
        self.among.publish(String(data="mine"))
        self.near.publish(Float32(data=0.3))
        picture = Image(width=2, height=1, step=6, encoding="bgr8", data=bytes(6))
        self.still.publish(picture)
        picture.data = bytes([self.count % 256] * 6)
        self.image.publish(picture)

    def on_set(self, parameters: list[Any]) -> SetParametersResult:
        bad = any(each.name == "limit" and each.value < 0 for each in parameters)
        return SetParametersResult(successful=not bad, reason="must not be negative" if bad else "")

    def on_ask(self, message: String) -> None:
        self.get_logger().warning(f"asked: {message.data}")  # type: ignore[no-untyped-call]
        self.answer.publish(String(data=message.data.upper()))

    def on_ask_twice(self, _: String) -> None:
        """Answer from the second time on, as if the first answer had been lost."""
        self.asked += 1
        if self.asked > 1:
            self.second.publish(String(data="yes"))

    def on_among(self, message: String) -> None:
        """Repeat what is said, but for the first words of others, as if they had been lost."""
        self.told += message.data != "mine"
        if message.data == "mine" or self.told > 1:
            self.echo.publish(message)

    def on_add(self, request: Any, response: Any) -> Any:
        response.sum = request.a + request.b
        return response

    def on_goal(self, handle: Any) -> Any:
        """Feedback twice a second, until cancelled; a goal at x = 0 is reached at once."""
        rate = self.create_rate(20)
        while handle.request.x and not handle.is_cancel_requested:
            handle.publish_feedback(DriveToPoint.Feedback(distance=handle.request.x))
            rate.sleep()
        if handle.is_cancel_requested:
            handle.canceled()
            return DriveToPoint.Result(reached=False, message="cancelled")
        handle.succeed()
        return DriveToPoint.Result(reached=True, message="there")


def main() -> None:
    """Run until told to end."""
    rclpy.init()
    node = Actor()
    try:
        executor = MultiThreadedExecutor(3)
        executor.add_node(node)
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == "__main__":
    main()

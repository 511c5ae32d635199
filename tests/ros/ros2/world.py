"""A graph whose every name is known: one node that publishes, serves, acts and has parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.action import ActionServer, GoalResponse
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import Float32, String

from tests.ros.peer import LATCHED, Peer

if TYPE_CHECKING:
    from rclpy.action.server import ServerGoalHandle
    from rclpy.parameter import Parameter

EVERY_S = 0.05
BEST_EFFORT = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)


class World(Peer):
    """The node `/turtle`."""

    def __init__(self, domain: int) -> None:
        super().__init__(domain, "turtle")
        node = self.node
        self.heard: list[String] = self.hear("/ai_command", String)
        self._latched = self.publisher("/word", String, LATCHED)
        self._latched.publish(String(data="вперёд: 'x' #1"))
        self._wheels = self.publisher("/wheels", JointState)
        self._image = self.publisher("/image", Image, BEST_EFFORT)
        self._distance = self.publisher("/distance", Float32)
        node.create_timer(EVERY_S, self._publish)
        node.create_service(AddTwoInts, "/add", self._add)
        self._action = ActionServer(node, Fibonacci, "/fibonacci", self._count, goal_callback=_accepts)
        node.declare_parameter("speed", 0.5, _LIMITED)
        node.declare_parameter("safe.near", value=3)
        node.declare_parameter("name", "лис")
        node.declare_parameter("on", value=True)
        node.declare_parameter("gains", [1.0, 2.5])
        node.declare_parameter("later", descriptor=ParameterDescriptor(dynamic_typing=True))
        node.add_on_set_parameters_callback(_refuses)

    def close(self) -> None:
        self._action.destroy()
        super().close()

    def _publish(self) -> None:
        wheels = JointState(name=["left", "right"], velocity=[1.5, -0.25])
        wheels.header.frame_id = "base_link"
        wheels.header.stamp = self.node.get_clock().now().to_msg()
        self._wheels.publish(wheels)
        self._image.publish(Image(height=2, width=100, encoding="rgb8", data=bytes(600)))
        self._distance.publish(Float32(data=0.25))

    @staticmethod
    def _add(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        response.sum = request.a + request.b
        return response

    @staticmethod
    def _count(goal: ServerGoalHandle) -> Fibonacci.Result:
        sequence = [0, 1]
        while len(sequence) < goal.request.order:
            sequence.append(sequence[-1] + sequence[-2])
            goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
        goal.succeed()
        return Fibonacci.Result(sequence=sequence)


_LIMITED = ParameterDescriptor(
    description="metres a second", floating_point_range=[FloatingPointRange(from_value=0.0, to_value=2.0)]
)


def _refuses(parameters: list[Parameter]) -> SetParametersResult:
    bad = any(parameter.name == "name" and not parameter.value for parameter in parameters)
    return SetParametersResult(successful=not bad, reason="a name is needed" if bad else "")


def _accepts(goal: Fibonacci.Goal) -> GoalResponse:
    return GoalResponse.ACCEPT if goal.order >= 0 else GoalResponse.REJECT

"""/mock/motors: the true motion of the simulated robot's motors, whatever is reported."""

from __future__ import annotations

from typing import TYPE_CHECKING

from sensor_msgs.msg import JointState

from nodes.parts.qos import DEPTH
from robot.joints import DRIVE_JOINTS
from robot.topics import MOCK_MOTORS
from robot.world.world import STEP_S

if TYPE_CHECKING:
    from nodes.parts.node import LessonNode
    from robot.world.world import World

_EVERY = 2


class MockMotors:
    """Publishes 50 times a second, while somebody is subscribed.

    `velocity` is the speed of each wheel in rad/s, `position` its total rotation in rad, which
    includes even the smallest motion between two messages. `effort` is the highest speed that the
    motor was driven at since the last message, rad/s, 0 while it is off. The last joint is the
    steering.
    """

    def __init__(self, node: LessonNode, world: World) -> None:
        self._node, self._world = node, world
        self._turned = [0.0, 0.0]
        self._driven = [0.0, 0.0]
        self._steps = 0
        self._publisher = node.create_publisher(JointState, MOCK_MOTORS, DEPTH)

    def step(self) -> None:
        """Add the motion of one `STEP_S`."""
        wheels, asked = self._world.wheels, self._world.asked
        self._turned[0] += wheels.left_rad_s * STEP_S
        self._turned[1] += wheels.right_rad_s * STEP_S
        self._driven[0] = max(self._driven[0], asked.left_rad_s, key=abs)
        self._driven[1] = max(self._driven[1], asked.right_rad_s, key=abs)
        self._steps += 1
        if self._steps % _EVERY == 0:
            if self._publisher.get_subscription_count():
                self._publish()
            self._driven = [0.0, 0.0]

    def _publish(self) -> None:
        wheels = self._world.wheels
        message = JointState(name=list(DRIVE_JOINTS))
        message.header.stamp = self._node.get_clock().now().to_msg()
        message.position = [*self._turned, wheels.steering_rad]
        message.velocity = [wheels.left_rad_s, wheels.right_rad_s, 0.0]
        message.effort = [*self._driven, 0.0]
        self._publisher.publish(message)

"""A simulated base: obeys drive commands by the bicycle model, publishes /odom and /tf.

With `auto` it replaces a real base only if nobody publishes /odom for two seconds after the start,
and turns itself off when somebody does: a robot with two odometries drives into a wall. After a
real one has appeared it never comes back: a real robot's position cannot be invented.
"""

from __future__ import annotations

import time
from collections.abc import Callable

from ackermann_msgs.msg import AckermannDriveStamped
from nav_msgs.msg import Odometry
from rclpy.publisher import Publisher
from tf2_msgs.msg import TFMessage

from nodes.parts.commands import from_message
from nodes.parts.node import DEPTH, LessonNode
from nodes.parts.odometry import fill, transform_to
from robot.limits import SPEED, STEERING, first_excess
from robot.motion.odometry import Pose, advance
from robot.topics import ODOMETRY, TF
from robot.words import STOP
from text.i18n import N_

AUTO, ALWAYS, NEVER = "auto", "always", "never"
"""Not `yes` and `no`: YAML, and thus ROS, reads those as true and false."""
WAIT_S = 2.0
"""How long to wait for another odometry."""
_PERIOD_S = 0.05
_LOOK_EVERY_S = 0.5

_BEGAN = N_("Nobody publishes {topic}: a simulated base obeys {commands}")
_STEPPED_BACK = N_("Somebody else publishes {topic}: the simulated base is off")


class SimulatedBase:
    """Obeys each command on `commands` until the next."""

    def __init__(
        self, node: LessonNode, mode: str, commands: str, wheelbase_m: float, held: Callable[[], bool]
    ) -> None:
        """Read /drive or another topic of `commands`; stand and ignore commands while `held`."""
        self._node, self._commands, self._held = node, commands, held
        self._wheelbase_m = wheelbase_m
        self._pose, self._command, self._odometry = Pose(), STOP, Odometry()
        self._started_s = self._stepped_s = time.monotonic()
        self._publishers: tuple[Publisher, Publisher] | None = None
        node.create_subscription(AckermannDriveStamped, commands, self._hear, DEPTH)
        self._steps = node.every(_PERIOD_S, self._step)
        self._steps.cancel()
        self._looks = node.every(_LOOK_EVERY_S, self._look)
        if mode == ALWAYS:
            self._begin()
        if mode != AUTO:
            self._looks.cancel()

    @property
    def is_on(self) -> bool:
        """Whether this base publishes /odom."""
        return self._publishers is not None

    def stop(self) -> None:
        """Stand still, whatever was commanded."""
        self._step()
        self._command = STOP

    def _hear(self, message: AckermannDriveStamped) -> None:
        asked = from_message(message)
        beyond = first_excess((asked.speed_m_s, SPEED), (asked.steering_rad, STEERING))
        self.stop()
        if not self._held() and beyond is None:
            self._command = asked

    def _look(self) -> None:
        mine = 1 if self.is_on else 0
        if self._node.count_publishers(ODOMETRY) > mine:
            self._looks.cancel()
            self._end()
        elif not mine and time.monotonic() - self._started_s >= WAIT_S:
            self._begin()

    def _begin(self) -> None:
        self._publishers = (
            self._node.create_publisher(Odometry, ODOMETRY, DEPTH),
            self._node.create_publisher(TFMessage, TF, DEPTH),
        )
        self._stepped_s = time.monotonic()
        self._steps.reset()
        self._node.say.info(_BEGAN, topic=ODOMETRY, commands=self._commands)

    def _end(self) -> None:
        if self._publishers is not None:
            self._steps.cancel()
            for publisher in self._publishers:
                self._node.destroy_publisher(publisher)
            self._publishers = None
            self._node.say.warn(_STEPPED_BACK, topic=ODOMETRY)

    def _step(self) -> None:
        if self._publishers is None:
            return
        now_s = time.monotonic()
        passed_s, self._stepped_s = now_s - self._stepped_s, now_s
        self._pose = advance(self._pose, self._command, passed_s, self._wheelbase_m)
        odometry, transforms = self._publishers
        stamp = self._node.get_clock().now().to_msg()
        fill(self._odometry, self._pose, self._command, self._wheelbase_m, stamp)
        odometry.publish(self._odometry)
        transforms.publish(TFMessage(transforms=[transform_to(self._pose, stamp)]))

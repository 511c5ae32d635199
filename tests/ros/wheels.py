"""What the emulated motors do, and somebody who commands them: for tests of what stops a robot."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from ackermann_msgs.msg import AckermannDriveStamped
from sensor_msgs.msg import JointState

from tests.ros.peer import Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Callable

STANDS_WITHIN_S = 15.0
"""The slowest promise is 1.5 s; a machine under load is given more."""
STAYS_MESSAGES = 15
"""At 50 Hz."""
STANDS_MESSAGES = 50
"""More than a pause: a driver that was held up lets the wheels stand for 0.5 s, and goes on."""
SPEED, STEERING = 0.2, 0.45


class Wheels:
    """Hears the truth about the motors, and commands them by a topic at 10 Hz."""

    def __init__(self, peer: Peer) -> None:
        self.peer = peer
        self.told: list[JointState] = peer.hear("/mock/motors", JointState)
        self._timer: Any = None
        self._topic = ""

    # ---------------------------------------------------------------- commands

    def drive(self, speed_m_s: float = SPEED, topic: str = "/drive") -> None:
        """Command this speed on a circle, from now on."""
        message = AckermannDriveStamped()
        message.drive.speed, message.drive.steering_angle = speed_m_s, STEERING

        def stamped() -> AckermannDriveStamped:
            message.header.stamp = self.peer.node.get_clock().now().to_msg()
            return message

        self.command(topic, stamped)

    def command(self, topic: str, message: Callable[[], Any]) -> None:
        """Say something else ten times a second from now on, and on no other topic.

        Who is still there, and silent, is a reason for the chassis to stand.
        """
        self.quiet()
        if topic != self._topic:
            self.peer.retire(self._topic)
            self._topic = topic
        publisher = self.peer.publisher(topic, type(message()))
        self._timer = self.peer.node.create_timer(0.1, lambda: publisher.publish(message()))

    def quiet(self) -> None:
        if self._timer is not None:
            self.peer.node.destroy_timer(self._timer)
            self._timer = None

    def quiet_for(self, seconds: float) -> None:
        """Command nothing, and let so much time pass that what was commanded is old."""
        self.quiet()
        until_s = time.monotonic() + seconds
        wait_until(lambda: time.monotonic() > until_s, "time that passes")

    # ---------------------------------------------------------------- what is seen

    @property
    def turned(self) -> tuple[float, float]:
        """How far each wheel has turned so far, rad."""
        left, right, _steering = self.told[-1].position
        return left, right

    def wait_moving(self, way: int = 1) -> None:
        """Wait until both wheels turn that way."""
        seen = len(self.told)
        wait_until(
            lambda: len(self.told) > seen and min(way * v for v in self.told[-1].velocity[:2]) > 0.5, "turning wheels"
        )

    def assert_stands(self, within_s: float = STANDS_WITHIN_S) -> None:
        """See the wheels come to a stand, motors off, that is no pause."""
        seen = len(self.told)
        wait_until(
            lambda: len(self.told) > seen + STANDS_MESSAGES and still(self.told[-STANDS_MESSAGES:]),
            "standing wheels",
            within_s,
            0.01,
        )

    def assert_stays(self, since: int | None = None) -> None:
        """See no wheel turn for a while, or from that message until then."""
        begin = len(self.told) - 1 if since is None else since
        wait_until(lambda: len(self.told) >= begin + STAYS_MESSAGES, "news of the motors")
        self.assert_still(begin)

    def assert_still(self, since: int = 0) -> None:
        """No wheel has turned since that message, not by the smallest bit."""
        told = self.told[since:]
        assert still(told), [(m.position[0], m.effort[0]) for m in told]


def is_off(message: JointState) -> bool:
    """Whether no wheel turns and no motor is driven."""
    return not any([*message.velocity[:2], *message.effort[:2]])


def still(told: list[JointState]) -> bool:
    """Whether in all this time no wheel has turned and no motor was driven."""
    return all(is_off(message) and message.position[:2] == told[0].position[:2] for message in told)

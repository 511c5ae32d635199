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

STANDS_WITHIN_S = 3.0
"""The slowest promise is 1.5 s; a machine under load is given more."""
STAYS_MESSAGES = 20
"""At 50 Hz."""
SPEED, STEERING = 0.2, 0.45


class Wheels:
    """Hears the truth about the motors, and commands them by a topic at 10 Hz."""

    def __init__(self, peer: Peer) -> None:
        self.peer = peer
        self.told: list[JointState] = peer.hear("/mock/motors", JointState)
        self._timer: Any = None

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
        """Say something else ten times a second from now on."""
        self.quiet()
        publisher = self.peer.publisher(topic, type(message()))
        self._timer = self.peer.node.create_timer(0.1, lambda: publisher.publish(message()))

    def quiet(self) -> None:
        """Command nothing any more."""
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
            lambda: (
                len(self.told) > seen and min(way * v for v in self.told[-1].velocity[:2]) > 0.5
            ),
            "turning wheels",
        )

    def assert_stands(self, within_s: float = STANDS_WITHIN_S) -> float:
        """See the wheels stand soon and stay so, motors off; the seconds until then come back."""
        began = time.monotonic()
        self.wait_off(within_s)
        passed_s = time.monotonic() - began
        self.assert_stays(len(self.told) - 1)
        return passed_s

    def wait_off(self, within_s: float = 30.0) -> None:
        """Wait until no wheel turns and no motor is driven."""
        seen = len(self.told)
        wait_until(
            lambda: len(self.told) > seen and is_off(self.told[-1]), "motors off", within_s, 0.005
        )

    def assert_stays(self, since: int | None = None) -> None:
        """See no wheel turn for a while, or from that message until then."""
        begin = len(self.told) - 1 if since is None else since
        wait_until(lambda: len(self.told) >= begin + STAYS_MESSAGES, "news of the motors")
        self.assert_still(begin)

    def assert_still(self, since: int = 0) -> None:
        """No wheel has turned since that message, not by the smallest bit."""
        for before, now in zip(self.told[since:], self.told[since + 1 :], strict=False):
            assert now.position[:2] == before.position[:2], moved(self.told, before)
            assert is_off(now), moved(self.told, before)


def is_off(message: JointState) -> bool:
    """Whether no wheel turns and no motor is driven."""
    return not any([*message.velocity[:2], *message.effort[:2]])


def moved(told: list[JointState], last: JointState) -> str:
    """What the wheels did after that message, for a person."""
    begin = told.index(last)
    return f"wheels moved: {[(m.position[0], m.effort[0]) for m in told[begin : begin + 20]]}"

"""The safety node as a gate, with everything around it that a test plays."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, Any

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from std_msgs.msg import Float32

from tests.ros.node_process import NodeProcess
from tests.ros.node_thread import NodeThread
from tests.ros.peer import Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    import signal

    from rclpy.timer import Timer
    from typing_extensions import Self

FRONT, REAR = "/sensor/sonar_front", "/sensor/sonar_rear"


def drive(speed: float, steering: float = 0.0) -> AckermannDriveStamped:
    """A command in m/s and rad."""
    message = AckermannDriveStamped()
    message.drive.speed = speed
    message.drive.steering_angle = steering
    return message


def stamped(message: Any, since_s: float) -> Any:
    """The message with a stamp of so many seconds from now."""
    at_s = time.time() + since_s
    message.header.stamp = Time(sec=int(at_s), nanosec=int(at_s % 1 * 1e9))
    return message


BEYOND = (
    (0.8, 0.0, "0.8 m/s, limit 0.5 m/s"),
    (-1e30, 0.0, "-1e+30 m/s, limit 0.5 m/s"),
    (0.3, 1.2, "1.2 rad, limit 0.5 rad"),
    (math.nan, 0.0, "nan m/s, limit 0.5 m/s"),
    (0.3, math.inf, "inf rad, limit 0.5 rad"),
)
"""Speed and angle that nothing may obey, and what is said of them."""
STAMPS = (
    (-10.0, "s old by its stamp"),
    (-86400.0, "s behind this computer's clock"),
    (300.0, "s ahead of this computer's clock"),
    (1e6, "set the clocks of both computers"),
)
"""Seconds from now, and a part of what is said of it."""
LONG: dict[str, object] = {"stale_after_s": 60, "max_age_s": 60}
"""What is said or seen once counts for as long as the test takes."""


class Gate:
    """The safety node as a gate, with everything around it.

    `apart`: the module of it, to be a process that can be killed and held up.
    """

    def __init__(self, domain: int, *, apart: str = "", **params: object) -> None:
        self._domain, self._apart = domain, apart
        self._params = {"gate": True, "rate": 50, "settle_s": 0, **LONG, **params}
        self.process = self._started()
        self.peer = Peer(domain)
        self.safe = self.peer.hear("/drive_safe", AckermannDriveStamped)
        self.states = self.peer.hear("/safety_state", DiagnosticArray)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the node and the test's own."""
        self.peer.close()
        self.process.close()

    def send(self, number: signal.Signals) -> None:
        assert isinstance(self.process, NodeProcess)
        self.process.send(number)
        if number.name in ("SIGTERM", "SIGINT", "SIGKILL"):
            self.process.wait()

    def restart(self, **params: object) -> None:
        """Start it again, with other parameters if some are given."""
        self.process.close()
        self._params |= params
        self.process = self._started()

    def repeat(self, topic: str, message: Any) -> Timer:
        """Say it 20 times a second, until that is cancelled."""
        publisher = self.peer.publisher(topic, type(message))
        return self.peer.node.create_timer(0.05, lambda: publisher.publish(message))

    def see(self, distance: float, place: str = "front") -> None:
        """Give a reading, again and again as a sonar does, until the gate has taken it."""
        sonar = self.repeat(f"/sensor/sonar_{place}", Float32(data=distance))
        wait_until(
            lambda: self.states and values(self.states[-1])[f"{place}_m"] == f"{distance:.3f}",
            f"{distance} m {place}",
        )
        self.peer.node.destroy_timer(sonar)

    def wait_for_speed(self, speed: float) -> AckermannDriveStamped:
        """Wait until the gate lets this speed through, and no other."""
        self.safe.clear()
        wait_until(
            lambda: self.safe and self.safe[-1].drive.speed == pytest.approx(speed), f"{speed} m/s on /drive_safe"
        )
        return self.safe[-1]

    def wait_for_state(self, state: str) -> DiagnosticStatus:
        """Wait until that is its verdict; the newest status comes back."""
        wait_until(lambda: self.states and values(self.states[-1])["verdict"] == state, state)
        return self.states[-1].status[0]

    def _started(self) -> NodeProcess | NodeThread:
        if self._apart:
            return NodeProcess(self._apart, self._domain, params=self._params)
        return NodeThread("nodes.safety_stop", self._domain, params=self._params)


def values(message: DiagnosticArray) -> dict[str, str]:
    """The key-values of a /safety_state."""
    return {item.key: item.value for item in message.status[0].values}

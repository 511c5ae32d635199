"""The safety node as a gate, with everything around it that a test plays."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from std_msgs.msg import Float32

from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from rclpy.timer import Timer
    from typing_extensions import Self

FRONT, REAR = "/sensor/sonar_front", "/sensor/sonar_rear"


def drive(speed: float, steering: float = 0.0) -> AckermannDriveStamped:
    """A command in m/s and rad."""
    message = AckermannDriveStamped()
    message.drive.speed = speed
    message.drive.steering_angle = steering
    return message


LONG: dict[str, object] = {"stale_after_s": 60, "max_age_s": 60}
"""What is said or seen once counts for as long as the test takes."""


class Gate:
    """The safety node as a gate, with everything around it."""

    def __init__(self, domain: int, *, module: str = "nodes.safety_stop", **params: object) -> None:
        self._domain, self._module = domain, module
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
            lambda: self.safe and self.safe[-1].drive.speed == pytest.approx(speed),
            f"{speed} m/s on /drive_safe",
        )
        return self.safe[-1]

    def wait_for_state(self, state: str) -> DiagnosticStatus:
        """Wait until that is its verdict; the newest status comes back."""
        wait_until(lambda: self.states and values(self.states[-1])["verdict"] == state, state)
        return self.states[-1].status[0]

    def _started(self) -> NodeProcess:
        return NodeProcess(self._module, self._domain, params=self._params)


def values(message: DiagnosticArray) -> dict[str, str]:
    """The key-values of a /safety_state."""
    return {item.key: item.value for item in message.status[0].values}

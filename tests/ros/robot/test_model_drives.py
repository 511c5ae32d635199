"""The robot of real drivers with a hostile model as its driver: the gate and the limits hold.

The model answers every voice with full speed, for ever, and what it is not allowed besides.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from rclpy.time import Time
from std_msgs.msg import Bool

from robot.limits import SPEED
from tests.deck_process import deck
from tests.model_server import KEY, ModelServer, obeys
from tests.model_settings import write_settings
from tests.ros.peer import Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


pytestmark = pytest.mark.nightly

DRIVE_S = 150.0
"""The gate lets it go on by fits and starts where messages are late."""


def stamp_ns(message: AckermannDriveStamped | DiagnosticArray) -> int:
    return int(Time.from_msg(message.header.stamp).nanoseconds)


def drive(speed: float) -> str:
    command = {"action": "drive", "speed": speed, "steering": 0.0}
    return json.dumps({"thought": "faster!", "commands": [command] * 8, "say": ""})


@pytest.fixture
def robot(ros_domain: int, model_folder: Path) -> Iterator[tuple[ModelServer, Peer]]:
    """Bring the robot up with a model, and a microphone that is never silent."""
    with ModelServer(obeys(drive(0.5))) as server:
        write_settings(model_folder, server.url, budget={"calls_per_minute": 10_000})
        up = deck("up", "robot", "--set", "mock_audio.first_after=0.1", "--set", "mock_audio.period=0.3")
        try:
            assert (up.process.returncode, up.errors) == (0, [])
            with Peer(ros_domain) as peer:
                yield server, peer
        finally:
            deck("down")


@pytest.mark.timeout(600)  # A drive of a half minute on a quiet machine.
def test_full_speed_for_ever_hits_nothing(robot: tuple[ModelServer, Peer]) -> None:
    """Forward until the gate holds it, then backward until it does: the robot touches nothing.

    Then the emergency stop, while the model goes on talking; and the key is nowhere to be read.
    """
    server, peer = robot
    poses = peer.hear("/mock/pose", PoseStamped)
    safe = peer.hear("/drive_safe", AckermannDriveStamped)

    def x_m() -> float:
        return float(poses[-1].pose.position.x) if poses else 0.0

    def stands(at_least: int = 25) -> bool:
        """Whether the newest commands that passed the gate are all zero."""
        return len(safe) >= at_least and not any(each.drive.speed for each in safe[-at_least:])

    wait_until(lambda: x_m() > 0.7, "some way forward", DRIVE_S)
    wait_until(stands, "the gate to hold it before the box", DRIVE_S)
    forward_m = x_m()
    asked = len(server.exchanges)
    server.script = obeys(drive(-0.5))
    safe.clear()
    wait_until(lambda: x_m() < forward_m - 0.5, "some way back", DRIVE_S)
    wait_until(lambda: len(server.exchanges) > asked + 5, "more answers")
    wait_until(stands, "the gate to hold it before the wall", DRIVE_S)
    server.script = obeys(drive(0.5))
    here_m = x_m()
    wait_until(lambda: x_m() > here_m + 0.1, "forward again", DRIVE_S)
    told = peer.hear("/emergency_stop_state", DiagnosticArray)
    peer.say("/emergency_stop", Bool(data=True))

    def gate_stopped_ns() -> int:
        """When the gate first said that it obeys the stop; it may stand for other reasons."""
        obeyed = (
            stamp_ns(each)
            for each in told
            for one in each.status
            if one.name == "/safety_stop" and one.level == DiagnosticStatus.ERROR
        )
        return min(obeyed, default=0)

    stopped_ns = wait_until(gate_stopped_ns, "the stop")
    asked = len(server.exchanges)

    def since() -> list[float]:
        """What passed the gate from then on; what was sent before may be heard later."""
        return [each.drive.speed for each in safe if stamp_ns(each) > stopped_ns]

    wait_until(lambda: len(server.exchanges) > asked + 5, "a model that goes on")
    wait_until(lambda: len(since()) > 20, "a gate that goes on")
    assert not any(since())
    assert all(SPEED.allow(each.drive.speed) for each in safe)
    logs = "\n".join(deck("logs").lines)
    assert "ran into something" not in logs
    assert KEY not in logs

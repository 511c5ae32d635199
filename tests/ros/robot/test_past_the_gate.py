"""Whoever publishes past the gate or the differential does not make the robot move."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from sensor_msgs.msg import JointState

from robot.joints import DRIVE_JOINTS
from tests.ros.peer import Peer
from tests.ros.robot_nodes import NODES, RobotNodes

if TYPE_CHECKING:
    from collections.abc import Iterator


@pytest.fixture(scope="module")
def robot(module_domain: int, tmp_path_factory: pytest.TempPathFactory) -> Iterator[RobotNodes]:
    nodes = RobotNodes(module_domain, tmp_path_factory.mktemp("robot") / "devices")
    nodes.start(*NODES)
    yield nodes
    nodes.close()


def setpoint() -> AckermannDriveStamped:
    message = AckermannDriveStamped()
    message.drive.speed = 0.4
    return message


def wheels() -> JointState:
    nan = float("nan")
    return JointState(name=list(DRIVE_JOINTS), velocity=[5.0, 5.0, nan], position=[nan, nan, 0.0])


@pytest.mark.parametrize(
    ("topic", "message", "owner"),
    [("/drive_safe", setpoint(), "safety_stop"), ("/wheel_commands", wheels(), "electronic_differential")],
    ids=["drive_safe", "wheel_commands"],
)
def test_the_slowest_command_counts(robot: RobotNodes, topic: str, message: Any, owner: str) -> None:
    # The gate drives nobody: no source has asked for anything.
    robot.wheels.assert_stands()
    with Peer(robot.domain, "evil") as evil, evil.saying(topic, message, 0.02):
        robot.processes[owner].wait_for_words("also published by /evil", "the slowest command")
        robot.wheels.assert_stands()
        robot.wheels.assert_stays()

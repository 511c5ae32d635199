"""Two publishers of a distance: a forgotten one does not drive the robot into the wall."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from diagnostic_msgs.msg import DiagnosticArray
from std_msgs.msg import Float32

from tests.ros.peer import Peer
from tests.ros.robot_nodes import NODES, RobotNodes
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

pytestmark = pytest.mark.nightly

FRONT = "/sensor/sonar_front"


@pytest.fixture
def robot(ros_domain: int, tmp_path: Path) -> Iterator[RobotNodes]:
    nodes = RobotNodes(ros_domain, tmp_path / "devices")
    nodes.start(*NODES)
    yield nodes
    nodes.close()


def ahead(robot: RobotNodes) -> AckermannDriveStamped:
    message = AckermannDriveStamped()
    message.drive.speed = 0.4
    message.header.stamp = robot.peer.node.get_clock().now().to_msg()
    return message


@pytest.mark.parametrize("distance_m", [9.0, math.inf])
@pytest.mark.parametrize("every_s", [0.02, 0.3])
def test_the_robot_stops_before_the_wall_whoever_says_that_the_way_is_free(
    robot: RobotNodes, distance_m: float, every_s: float
) -> None:
    states = robot.peer.hear("/safety_state", DiagnosticArray)
    with (
        Peer(robot.domain, "forgotten") as forgotten,
        forgotten.saying(FRONT, Float32(data=distance_m), every_s),
    ):
        gate = robot.processes["safety_stop"]
        gate.wait_for_words("is published by several", "forgotten", "the lowest distance counts")
        robot.wheels.command("/drive", lambda: ahead(robot))
        robot.wheels.wait_moving()
        wait_until(
            lambda: any(
                ("front", "close") in {(pair.key, pair.value) for pair in status.values}
                for message in states[-50:]
                for status in message.status
            ),
            "an obstacle ahead",
            60.0,
        )
        robot.wheels.assert_stands()
        robot.wheels.assert_stays()
    robot.wheels.quiet()
    assert "ran into something" not in robot.robot.output

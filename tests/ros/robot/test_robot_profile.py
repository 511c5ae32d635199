"""`deck up robot`: all nodes on emulated devices, and a box in the way of where it is sent."""

from __future__ import annotations

import json
from collections.abc import Iterator

import pytest
from geometry_msgs.msg import PoseStamped
from std_msgs.msg import Float32

from tests.deck_process import deck
from tests.ros.nodes.test_drive_to_point import ABORTED, Asker
from tests.ros.peer import Peer
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

GOAL_M = 3.0
"""Straight ahead, behind a box that begins 1.75 m in front of the sonar."""


@pytest.fixture
def robot(ros_domain: int) -> Iterator[list[str]]:
    """Bring the robot up; its nodes."""
    up = deck("up", "robot", "--set", "drive_to_point.patience_s=1.0")
    try:
        assert (up.process.returncode, up.errors) == (0, [])
        (session,) = json.loads("\n".join(deck("ps", "--json").lines))
        assert session["domain"] == ros_domain
        yield [node["node"] for node in session["nodes"] if node["state"] == "ready"]
    finally:
        deck("down")


def test_the_robot_drives_up_to_a_box_and_stands(robot: list[str], ros_domain: int) -> None:
    assert {"mock_robot", "chassis", "sonar_front", "head_controller", "ai_brain"} <= set(robot)
    with Peer(ros_domain) as peer:
        poses = peer.hear("/mock/pose", PoseStamped)
        fronts = peer.hear("/sensor/sonar_front", Float32)
        asker = Asker(peer)
        assert asker.ask(GOAL_M, 0.0)
        wait_until(lambda: poses and poses[-1].pose.position.x > 0.7, "some way")
        status, result = asker.end()
        assert status == ABORTED
        assert "a safety gate or an obstacle" in result.message
        assert 0.7 < poses[-1].pose.position.x < 1.7, "it stands before the box"
        assert min(front.data for front in fronts if front.data > 0) > 0.4
    said = "\n".join(deck("logs", "mock_robot").lines)
    assert "ran into something" not in said

"""An emergency stop is never forgotten: whatever dies, nothing moves until somebody releases it."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.duration import Duration
from std_msgs.msg import Bool

from tests.ros.node_process import NodeProcess
from tests.ros.peer import LATCHED, Peer
from tests.ros.robot_nodes import NODES, RobotNodes
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

OBEYING = {"/chassis", "/electronic_differential", "/safety_stop"}


class Holders:
    """What each node says of its own stop."""

    def __init__(self, peer: Peer) -> None:
        self._told: list[DiagnosticArray] = peer.hear("/emergency_stop_state", DiagnosticArray)

    def values(self, node: str) -> dict[str, str]:
        """The newest word of a node, {} before its first."""
        for message in reversed(self._told):
            for status in message.status:
                if status.name == node:
                    held = status.level == DiagnosticStatus.ERROR
                    found = {pair.key: pair.value for pair in status.values}
                    assert found["engaged"] == str(held).lower()
                    return found
        return {}

    def wait(self, engaged: bool, nodes: set[str]) -> None:
        """Wait until each of these nodes says so, from now on."""
        self._told.clear()
        wanted = str(engaged).lower()
        wait_until(
            lambda: all(self.values(node).get("engaged") == wanted for node in nodes),
            f"engaged {wanted} from {sorted(nodes)}",
        )


@pytest.fixture
def robot(ros_domain: int, tmp_path: Path) -> Iterator[RobotNodes]:
    nodes = RobotNodes(ros_domain, tmp_path / "devices")
    nodes.start(*NODES)
    yield nodes
    nodes.close()


def stop_from_one_who_is_killed(robot: RobotNodes) -> None:
    """Stop a robot that drives; nobody that has said so is there any more."""
    robot.wheels.drive()
    robot.wheels.wait_moving()
    holders = Holders(robot.peer)
    with Peer(robot.domain, "passer_by") as other:
        other.say("/emergency_stop", Bool(data=True), listeners=6, qos=LATCHED)
        robot.wheels.assert_stands()
        wait_until(
            lambda: "/passer_by" in holders.values("/chassis").get("publishers", "").split(),
            "the name of who has stopped it",
        )


def release(robot: RobotNodes, holders: Holders) -> None:
    """Say so again and again: those that were killed still count as listeners."""
    with robot.peer.saying("/emergency_stop", Bool(data=False)):
        holders.wait(False, OBEYING)


def test_all_is_killed_with_the_pico_and_nothing_moves_until_the_release(robot: RobotNodes) -> None:
    holders = Holders(robot.peer)
    stop_from_one_who_is_killed(robot)
    holders.wait(True, OBEYING)
    robot.end(*NODES, number=signal.SIGKILL)
    robot.kill_robot()
    robot.start_robot()
    robot.start(*NODES)
    holders.wait(True, OBEYING)
    assert holders.values("/safety_stop")["remembered"] == "true"
    robot.processes["safety_stop"].wait_for_words("EMERGENCY STOP, given before")
    since = len(robot.wheels.told)
    robot.wheels.drive()
    robot.wheels.assert_stands()
    robot.wheels.assert_still(since)
    release(robot, holders)
    robot.wheels.drive()
    robot.wheels.wait_moving()
    robot.wheels.quiet()


@pytest.mark.parametrize("name", ["safety_stop", "electronic_differential", "chassis"])
def test_each_node_that_comes_back_alone_holds_still(robot: RobotNodes, name: str) -> None:
    holders = Holders(robot.peer)
    stop_from_one_who_is_killed(robot)
    robot.end(name, number=signal.SIGKILL)
    robot.start(name)
    holders.wait(True, OBEYING)
    robot.wheels.assert_stays()
    release(robot, holders)
    robot.end(name, number=signal.SIGKILL)
    robot.start(name)
    # A stop that is released is no more there for who comes later.
    holders.wait(False, OBEYING)


def test_a_stop_that_only_the_pico_has_kept_is_that_of_the_chassis(robot: RobotNodes) -> None:
    holders = Holders(robot.peer)
    stop_from_one_who_is_killed(robot)
    robot.end("chassis", number=signal.SIGKILL)
    # Released by everybody but the one that was away.
    with robot.peer.saying("/emergency_stop", Bool(data=False)):
        holders.wait(False, OBEYING - {"/chassis"})
    robot.start("chassis")
    holders.wait(True, {"/chassis"})
    assert holders.values("/chassis")["by"] == "pico"
    robot.wheels.drive()
    robot.wheels.assert_stays()
    release(robot, holders)
    robot.wheels.wait_moving()
    robot.wheels.quiet()


def test_who_comes_late_and_hears_only_latched_words_is_told(ros_domain: int) -> None:
    with NodeProcess("nodes.electronic_differential", ros_domain), Peer(ros_domain) as peer:
        peer.say("/emergency_stop", Bool(data=True), listeners=2, qos=LATCHED)
        Holders(peer).wait(True, {"/electronic_differential"})
        with Peer(ros_domain, "late") as late:
            told = late.hear("/emergency_stop_state", DiagnosticArray, LATCHED)
            wait_until(lambda: told, "the state")
            (status,) = told[0].status
            assert status.level == DiagnosticStatus.ERROR
            assert status.name == "/electronic_differential"


def test_a_release_from_before_a_node_releases_nothing(ros_domain: int) -> None:
    """It arrives late, and is too old to be compared with the stop by the clock of its sender."""
    with (
        NodeProcess("nodes.electronic_differential", ros_domain),
        Peer(ros_domain) as peer,
        Peer(ros_domain, "past") as past,
    ):
        past.say("/emergency_stop", Bool(data=False), listeners=2, qos=LATCHED)
        said_s = time.monotonic()
        peer.say("/emergency_stop", Bool(data=True), listeners=1)
        holders = Holders(peer)
        holders.wait(True, {"/electronic_differential"})
        wait_until(lambda: time.monotonic() - said_s > 4.0, "a release that is old")
        with NodeProcess("nodes.safety_stop", ros_domain):
            publisher = past.publisher("/emergency_stop", Bool, LATCHED)
            wait_until(lambda: publisher.get_subscription_count() == 4, "both nodes")
            assert publisher.wait_for_all_acked(Duration(seconds=20))
            for _ in range(2):
                holders.wait(True, {"/electronic_differential", "/safety_node"})


def test_a_state_directory_that_cannot_be_written_is_told_and_stops_all_the_same(
    ros_domain: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("DECK_STATE_DIR", str(tmp_path / "file" / "state"))
    with NodeProcess("nodes.electronic_differential", ros_domain) as node, Peer(ros_domain) as peer:
        node.wait_for_words("not known whether an emergency stop was given before")
        holders = Holders(peer)
        holders.wait(True, {"/electronic_differential"})
        with peer.saying("/emergency_stop", Bool(data=False)):
            holders.wait(False, {"/electronic_differential"})
        peer.say("/emergency_stop", Bool(data=True), qos=LATCHED)
        holders.wait(True, {"/electronic_differential"})
        node.wait_for_words("cannot be written to disk")


def test_a_file_that_makes_no_sense_is_a_stop_until_it_is_released(ros_domain: int) -> None:
    path = Path(os.environ["DECK_STATE_DIR"], "stops", str(ros_domain))
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("{")
    with NodeProcess("nodes.electronic_differential", ros_domain), Peer(ros_domain) as peer:
        holders = Holders(peer)
        holders.wait(True, {"/electronic_differential"})
        with peer.saying("/emergency_stop", Bool(data=False)):
            holders.wait(False, {"/electronic_differential"})
        wait_until(lambda: not path.exists(), "the file gone")

"""Whatever dies between a command and the wheels, the wheels stand, as the emulated motors tell.

The nodes and their parameters are those of profiles/robot.yaml. They are started once; each test
leaves them running, and the robot standing.
"""

from __future__ import annotations

import signal
from collections.abc import Callable
from functools import partial
from itertools import count
from typing import TYPE_CHECKING, Any

import pytest
import serial
from ackermann_msgs.msg import AckermannDriveStamped
from std_msgs.msg import Bool

from robot.wire.pico import Drive, Hello, PicoDecoder, Telemetry, encode
from tests.ros.devices import set_parameter
from tests.ros.nodes.test_chassis import wheels as wheel_command
from tests.ros.peer import LATCHED
from tests.ros.robot_nodes import BELIEVED_S, NODES, RobotNodes, shuffled
from tests.ros.wheels import SPEED, STEERING
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

pytestmark = pytest.mark.nightly


@pytest.fixture(scope="module")
def module_nodes(module_domain: int, tmp_path_factory: pytest.TempPathFactory) -> Iterator[RobotNodes]:
    nodes = RobotNodes(module_domain, tmp_path_factory.mktemp("still") / "devices")
    nodes.start(*shuffled(NODES, 1))
    yield nodes
    nodes.close()


@pytest.fixture
def nodes(request: pytest.FixtureRequest, module_nodes: RobotNodes) -> Iterator[RobotNodes]:
    """Everything runs, nobody commands, and the robot stands."""
    module_nodes.mend()
    yield module_nodes
    request.node.add_report_section("teardown", "nodes", module_nodes.said())
    module_nodes.wheels.drive(0.0)
    # Not only in a pause, after which a node that was held up hears older commands first.
    module_nodes.wheels.assert_stands()
    module_nodes.wheels.quiet()


Fall = Callable[[str], None]


@pytest.fixture(params=["killed", "hung"])
def fall(request: pytest.FixtureRequest, nodes: RobotNodes) -> Fall:
    if request.param == "killed":
        return lambda name: nodes.end(name, number=signal.SIGKILL)
    return nodes.hang


def wait_back_and_still(nodes: RobotNodes, *names: str) -> None:
    """Let nodes be there again, after commands have become old; nothing may move by itself."""
    nodes.wheels.quiet_for(2 * BELIEVED_S)
    since = len(nodes.wheels.told)
    for name in names:
        if name in nodes.processes:
            nodes.wake(name)
    nodes.start(*(name for name in names if name not in nodes.processes))
    nodes.wheels.assert_stays()
    nodes.wheels.assert_still(since)
    nodes.renew()


@pytest.mark.parametrize("name", ["chassis", "electronic_differential", "safety_stop"])
def test_without_a_node_the_wheels_stand_until_a_new_command(nodes: RobotNodes, fall: Fall, name: str) -> None:
    nodes.wheels.drive()
    nodes.wheels.wait_moving()
    fall(name)
    nodes.wheels.assert_stands()
    wait_back_and_still(nodes, name)
    nodes.wheels.drive()
    nodes.wheels.wait_moving()


def test_without_a_sonar_nothing_goes_its_way(nodes: RobotNodes, fall: Fall) -> None:
    nodes.wheels.drive()
    nodes.wheels.wait_moving()
    fall("sonar_front")
    nodes.wheels.assert_stands()
    nodes.wheels.drive(-SPEED)
    nodes.wheels.wait_moving(-1)
    fall("sonar_rear")
    nodes.wheels.assert_stands()
    wait_back_and_still(nodes, "sonar_front", "sonar_rear")
    nodes.wheels.drive()
    nodes.wheels.wait_moving()


def test_commands_that_have_waited_for_who_hung_are_old(nodes: RobotNodes) -> None:
    nodes.wheels.drive()
    nodes.wheels.wait_moving()
    nodes.hang("electronic_differential")
    nodes.wheels.assert_stands()
    # Its queue is full, and nobody puts a stop behind.
    nodes.hang("safety_stop")
    wait_back_and_still(nodes, "electronic_differential")
    wait_back_and_still(nodes, "safety_stop")


def test_an_emergency_stop_holds_in_each_place_by_itself(nodes: RobotNodes) -> None:
    peer, wheels = nodes.peer, nodes.wheels
    wheels.drive()
    wheels.wait_moving()
    peer.say("/emergency_stop", Bool(data=True), listeners=6, qos=LATCHED)
    wheels.assert_stands()
    # The gate.
    allowed = peer.hear("/drive_safe", AckermannDriveStamped)
    wait_until(lambda: len(allowed) > 5, "the word of the gate")
    assert not any(message.drive.speed for message in allowed)
    # The chassis, without anybody before it.
    nodes.end("safety_stop", "electronic_differential", number=signal.SIGKILL)
    wheels.command("/wheel_commands", lambda: wheel_command(4.0, STEERING))
    wheels.assert_stays()
    # The Pico, without any of them, after its cable was out.
    nodes.end("chassis", number=signal.SIGKILL)
    set_parameter(peer, "mock_robot", "pico", "unplugged")
    set_parameter(peer, "mock_robot", "pico", "fine")
    since = len(wheels.told)
    assert "E" in flags_after_driving(nodes.folder / "pico")
    wheels.assert_still(since)
    wheels.quiet()
    nodes.start("chassis", "electronic_differential", "safety_stop")
    # Again and again: those that were killed still count as listeners in place of the new ones.
    with peer.saying("/emergency_stop", Bool(data=False)):
        wheels.assert_stays()
        wheels.drive()
        wheels.wait_moving()


def flags_after_driving(path: Path) -> frozenset[str]:
    """Tell the Pico to drive as a chassis would that knows of no emergency stop."""
    decoder, told = PicoDecoder(), list[Telemetry]()
    sequence = count(1)
    with serial.Serial(str(path), 115_200, timeout=0.02, exclusive=True) as port:
        port.write(encode(Hello(0)))

        def drive(speed_rad_s: float) -> int:
            port.write(encode(Drive(next(sequence), speed_rad_s, speed_rad_s, 0.0)))
            messages = decoder.feed(port.read(400))
            told.extend(message for message in messages if isinstance(message, Telemetry))
            return len(told)

        wait_until(lambda: drive(0.0) > 2, "telemetry")
        wait_until(lambda: drive(5.0) > 20, "more telemetry")
    return told[-1].flags


def test_what_was_commanded_before_a_fault_is_over_does_not_count(nodes: RobotNodes) -> None:
    peer, wheels, way = nodes.peer, nodes.wheels, 1
    # Straight to the chassis, and believed for long.
    set_parameter(peer, "chassis", "max_age_s", 60.0)
    nodes.end("electronic_differential")
    troubles: tuple[tuple[str, Any, Any], ...] = (("driver_fault", "left", "none"), ("battery", 5.0, 7.4))
    for trouble, value, fine in troubles:
        wheels.command("/wheel_commands", partial(wheel_command, way * 4.0, STEERING))
        wheels.wait_moving(way)
        set_parameter(peer, "mock_robot", trouble, value)
        wheels.assert_stands()
        wheels.quiet()
        set_parameter(peer, "mock_robot", trouble, fine)
        wheels.assert_stays()
        way = -way
    wheels.command("/wheel_commands", partial(wheel_command, way * 4.0, STEERING))
    wheels.wait_moving(way)
    set_parameter(peer, "chassis", "max_age_s", 1.0)
    nodes.start("electronic_differential")


def test_ending_in_any_order_moves_no_wheel(nodes: RobotNodes) -> None:
    since = len(nodes.wheels.told)
    nodes.end(*shuffled(NODES, 2))
    nodes.start(*reversed(NODES))
    nodes.wheels.assert_still(since)
    nodes.wheels.drive()
    nodes.wheels.wait_moving()
    nodes.end(*shuffled(NODES, 3), number=signal.SIGTERM)
    nodes.wheels.assert_stands()

"""What lies beyond the limits, or is stamped long ago or ahead, moves nothing at any step."""

from __future__ import annotations

import math
import random
import time
from typing import TYPE_CHECKING, Any

import pytest
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState

from robot.limits import PICO_RAD_S, RIM_M_S, wheel_limits
from tests.ros.devices import mock_robot
from tests.ros.gate import Gate, drive, values
from tests.ros.node_process import NodeProcess
from tests.ros.nodes.test_chassis import wheels
from tests.ros.peer import Peer
from tests.ros.wheels import Wheels
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from ackermann_msgs.msg import AckermannDriveStamped

pytestmark = pytest.mark.nightly

RADIUS_M = 0.0325
BEYOND = [
    pytest.param(0.8, 0.0, "0.8 m/s, limit 0.5 m/s", id="a little too fast"),
    pytest.param(-1e30, 0.0, "-1e+30 m/s, limit 0.5 m/s", id="far too fast"),
    pytest.param(0.3, 1.2, "1.2 rad, limit 0.5 rad", id="steered too far"),
    pytest.param(math.nan, 0.0, "nan m/s, limit 0.5 m/s", id="no number"),
    pytest.param(0.3, math.inf, "inf rad, limit 0.5 rad", id="an infinite angle"),
]
STAMPS = [
    (-10.0, "s old by its stamp"),
    (-86400.0, "s behind this computer's clock"),
    (300.0, "s ahead of this computer's clock"),
    (1e6, "set the clocks of both computers"),
]
"""Seconds from now, and a part of what is said of it."""


def stamped(message: Any, since_s: float) -> Any:
    """The message with a stamp of so many seconds from now."""
    at_s = time.time() + since_s
    message.header.stamp = Time(sec=int(at_s), nanosec=int(at_s % 1 * 1e9))
    return message


def fastest(told: list[JointState]) -> float:
    """The fastest that any of these commands lets a wheel turn, rad/s."""
    return max((abs(speed) for message in told for speed in message.velocity[:2]), default=0.0)


def turning(told: list[JointState]) -> bool:
    """Whether the newest of them turns a wheel."""
    return bool(told) and any(told[-1].velocity[:2])


# ---------------------------------------------------------------- the gate


@pytest.fixture
def gate(ros_domain: int) -> Iterator[Gate]:
    with Gate(ros_domain) as gate:
        gate.see(math.inf)
        yield gate


def refused_by(gate: Gate) -> str:
    """What the newest /safety_state says of a command that was refused."""
    return values(gate.states[-1]).get("refused", "") if gate.states else ""


@pytest.mark.parametrize(("speed", "steering", "words"), BEYOND)
def test_the_gate_refuses_what_is_beyond_the_limits(
    gate: Gate, speed: float, steering: float, words: str
) -> None:
    gate.peer.say("/drive", drive(0.2))
    gate.wait_for_speed(0.2)
    gate.peer.say("/drive", drive(speed, steering))
    wait_until(lambda: gate.safe[-1].drive.speed == 0, "a stop")
    wait_until(lambda: refused_by(gate) == words, f"{words} on /safety_state")
    status = gate.states[-1].status[0]
    assert status.level == DiagnosticStatus.WARN
    assert "refused" in status.message
    gate.process.wait_for_words("[ERROR]", "/drive", "refused")
    passed: list[AckermannDriveStamped] = gate.safe
    assert {round(one.drive.speed, 3) for one in passed} <= {0.0, 0.2}
    gate.peer.say("/drive", drive(-0.5, 0.5))
    gate.wait_for_speed(-0.5)
    wait_until(lambda: not refused_by(gate), "a state without it")


@pytest.mark.parametrize("max_age_s", [0.5, 0.0])
def test_the_gate_refuses_stamps_of_long_ago_and_of_other_clocks(
    ros_domain: int, max_age_s: float
) -> None:
    with Gate(ros_domain, max_age_s=max_age_s) as gate:
        gate.see(math.inf)
        gate.safe.clear()
        for since_s, words in STAMPS:
            with gate.peer.saying("/drive", stamped(drive(0.3), since_s)):
                gate.process.wait_for_words(words)
                wait_until(lambda: "stamp" in refused_by(gate), "a word on /safety_state")
        gate.peer.say("/drive", stamped(drive(0.1), 0.0))
        wait_until(lambda: any(one.drive.speed for one in gate.safe), "a fresh one")
        assert {round(one.drive.speed, 3) for one in gate.safe} <= {0.0, 0.1}


def test_a_stop_is_obeyed_whatever_its_stamp(ros_domain: int) -> None:
    """With `max_age_s` 0 nothing else would end the drive."""
    with Gate(ros_domain, max_age_s=0) as gate:
        gate.see(math.inf)
        for since_s in (-10.0, -1e6, 1e6):
            gate.peer.say("/drive", drive(0.3))
            gate.wait_for_speed(0.3)
            gate.peer.say("/drive", stamped(drive(0.0), since_s))
            gate.wait_for_speed(0.0)


# ---------------------------------------------------------------- the differential


@pytest.mark.parametrize(("speed", "steering", "words"), BEYOND)
def test_the_differential_refuses_what_is_beyond_the_limits(
    ros_domain: int, speed: float, steering: float, words: str
) -> None:
    with Peer(ros_domain) as peer, NodeProcess("nodes.electronic_differential", ros_domain) as node:
        heard = peer.hear("/wheel_commands", JointState)
        peer.say("/drive", drive(0.2, 0.1))
        wait_until(lambda: turning(heard), "turning wheels")
        peer.say("/drive", drive(speed, steering))
        wait_until(lambda: not turning(heard), "standing wheels")
        node.wait_for_words("[ERROR]", f"/drive asks for {words.partition(',')[0]}", "refused")
        assert fastest(heard) < 0.25 / RADIUS_M


@pytest.mark.parametrize("params", [{}, {"track": 0.4}, {"wheelbase": 0.1}], ids=str)
def test_the_outer_wheel_of_a_tight_curve_stays_within_its_limit(
    ros_domain: int, params: dict[str, object]
) -> None:
    with (
        Peer(ros_domain) as peer,
        NodeProcess("nodes.electronic_differential", ros_domain, params=params) as node,
    ):
        heard = peer.hear("/wheel_commands", JointState)
        peer.say("/drive", drive(0.5, 0.5))
        wait_until(lambda: turning(heard), "turning wheels")
        left, right, _nan = heard[-1].velocity
        assert right * RADIUS_M == pytest.approx(RIM_M_S)
        share = float(str(params.get("track", 0.15))) / 2 * math.tan(0.5)
        share /= float(str(params.get("wheelbase", 0.25)))
        assert left / right == pytest.approx((1 - share) / (1 + share))
        if params:
            node.wait_for_words("both are slowed")


def test_a_motor_that_is_slower_slows_both_wheels(ros_domain: int) -> None:
    params: dict[str, object] = {"max_wheel_speed": 5.0}
    with (
        Peer(ros_domain) as peer,
        NodeProcess("nodes.electronic_differential", ros_domain, params=params),
    ):
        heard = peer.hear("/wheel_commands", JointState)
        peer.say("/drive", drive(0.5, -0.3))
        wait_until(lambda: turning(heard), "turning wheels")
        assert fastest(heard) == pytest.approx(5.0)


@pytest.mark.parametrize("name", ["max_speed", "max_steering"])
def test_no_parameter_lifts_a_limit(ros_domain: int, name: str) -> None:
    params: dict[str, object] = {name: 0.6}
    with NodeProcess("nodes.electronic_differential", ros_domain, params=params) as node:
        assert node.wait() == 2
        assert f"{name} is 0.6, but must be a number from" in node.output
        assert "to 0.5" in node.output


@pytest.mark.parametrize("max_age_s", [0.5, 0.0])
def test_the_differential_refuses_stamps_as_the_gate_does(
    ros_domain: int, max_age_s: float
) -> None:
    params: dict[str, object] = {"max_age_s": max_age_s}
    with (
        Peer(ros_domain) as peer,
        NodeProcess("nodes.electronic_differential", ros_domain, params=params) as node,
    ):
        heard = peer.hear("/wheel_commands", JointState)
        for since_s, words in STAMPS:
            with peer.saying("/drive", stamped(drive(0.3), since_s)):
                node.wait_for_words(words)
        peer.say("/drive", stamped(drive(0.1), 0.0))
        wait_until(lambda: turning(heard), "a fresh one")
        assert fastest(heard) < 0.15 / RADIUS_M


def test_the_simulated_base_refuses_what_is_beyond_the_limits(ros_domain: int) -> None:
    params: dict[str, object] = {"simulate": "always"}
    with Peer(ros_domain) as peer, NodeProcess("nodes.drive_to_point", ros_domain, params=params):
        heard = peer.hear("/odom", Odometry)
        for speed, steering in ((1e30, 0.0), (0.8, 0.0), (0.2, 1.2), (math.nan, 0.0)):
            peer.say("/drive", drive(0.2))
            wait_until(lambda: heard and heard[-1].twist.twist.linear.x > 0, "motion")
            peer.say("/drive", drive(speed, steering))
            wait_until(lambda: heard[-1].twist.twist.linear.x == 0, "a stand")
        assert max(one.twist.twist.linear.x for one in heard) == pytest.approx(0.2)


# ---------------------------------------------------------------- the chassis


class Robot:
    """The chassis on the simulated robot, and somebody who commands it."""

    def __init__(self, domain: int, folder: Path, **params: object) -> None:
        self.peer = Peer(domain)
        self.mock = mock_robot(domain, folder)
        told: dict[str, object] = {"port": folder / "pico", "max_age_s": 0.5, **params}
        self.chassis = NodeProcess("nodes.chassis", domain, params=told)
        self.wheels = Wheels(self.peer)
        self.states = self.peer.hear("/diagnostics", DiagnosticArray)

    def close(self) -> None:
        self.chassis.close()
        self.mock.close()
        self.peer.close()

    @property
    def refused(self) -> str:
        """What the newest state says of a command that was refused."""
        return values(self.states[-1]).get("refused", "") if self.states else ""


@pytest.fixture
def robot(ros_domain: int, tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Robot]:
    robot = Robot(ros_domain, tmp_path, **getattr(request, "param", {}))
    robot.chassis.wait_for_words("The Pico answers")
    yield robot
    robot.close()


@pytest.mark.parametrize(
    ("speed", "steering", "words"),
    [
        (200.0, 0.0, "200 rad/s, limit 17.9"),
        (-1e308, 0.0, "-1e+308 rad/s, limit 17.9"),
        (3.0, 1.2, "1.2 rad, limit 0.5 rad"),
        (math.nan, 0.0, "nan rad/s, limit 17.9"),
    ],
)
def test_the_chassis_refuses_what_is_beyond_the_limits(
    robot: Robot, speed: float, steering: float, words: str
) -> None:
    robot.wheels.command("/wheel_commands", lambda: wheels(3.0))
    robot.wheels.wait_moving()
    robot.wheels.command("/wheel_commands", lambda: wheels(speed, steering))
    wait_until(lambda: robot.refused.startswith(words), f"{words} on /diagnostics")
    robot.wheels.assert_stands()
    robot.chassis.wait_for_words("[ERROR]", "/wheel_commands", "refused")
    assert robot.states[-1].status[0].level != DiagnosticStatus.OK
    # The controller of a wheel swings a little beyond what it was told.
    assert max(abs(one) for told in robot.wheels.told for one in told.effort[:2]) <= 3.0
    robot.wheels.command("/wheel_commands", lambda: wheels(wheel_limits().high))
    robot.wheels.wait_moving()


def test_whatever_is_asked_the_pico_is_never_sent_more_than_it_takes(robot: Robot) -> None:
    """The firmware would refuse it, and count; so would this test."""
    dice = random.Random(8)
    kinds = (0.0, 1.0, 17.9, 17.90602, 18.0, 200.0, 1e5, 1e30, 1e308, math.inf, math.nan)
    angles = (0.0, 0.1, 0.5, 0.50001, 1.57, 1e30, math.nan)

    def extreme() -> JointState:
        message = wheels(0.0, dice.choice(angles) * dice.choice((-1, 1)))
        speeds = (dice.choice(kinds) * dice.choice((-1, 1)) for _side in range(2))
        message.velocity = [*speeds, math.nan]
        return message

    publisher = robot.peer.publisher("/wheel_commands", JointState)
    wait_until(publisher.get_subscription_count, "a subscription")
    seen = len(robot.wheels.told)
    for _ in range(400):
        publisher.publish(extreme())
        # A pace, and no synchronisation: the queue is ten long, and the device has 4 KiB, of which
        # a second's worth is to be enough where it is held up. A line cut short would be refused.
        time.sleep(0.007)
    robot.wheels.command("/wheel_commands", lambda: wheels(2.0))
    robot.wheels.wait_moving()
    efforts = [abs(one) for told in robot.wheels.told[seen:] for one in told.effort[:2]]
    assert max(efforts) <= PICO_RAD_S
    robot.states.clear()
    wait_until(lambda: robot.states, "its state")
    assert values(robot.states[-1])["refused_by_pico"] == "0"


@pytest.mark.parametrize("robot", [{"max_wheel_speed": 4.0}], indirect=True)
def test_the_chassis_slows_both_wheels_to_its_own_limit(robot: Robot) -> None:
    curve = wheels(0.0)
    curve.velocity = [5.0, 10.0, math.nan]
    robot.wheels.command("/wheel_commands", lambda: curve)
    robot.wheels.wait_moving()
    wait_until(lambda: any(told.effort[1] for told in robot.wheels.told), "a driven motor")
    left, right, _none = next(told.effort for told in robot.wheels.told if told.effort[1])
    assert right == pytest.approx(4.0)
    assert left == pytest.approx(2.0)
    robot.chassis.wait_for_words("both are slowed")


def test_the_chassis_refuses_stamps_as_the_gate_does(robot: Robot) -> None:
    for since_s, words in STAMPS:
        with robot.peer.saying("/wheel_commands", stamped(wheels(3.0), since_s)):
            robot.chassis.wait_for_words(words)
    robot.wheels.assert_stands()
    robot.wheels.assert_still()
    robot.wheels.command("/wheel_commands", lambda: stamped(wheels(3.0), 0.0))
    robot.wheels.wait_moving()

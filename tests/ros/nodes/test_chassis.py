"""The driver of the chassis, against the robot that is not there: bytes to wheels and back."""

from __future__ import annotations

import math
import os
import random
import signal
import time
from typing import TYPE_CHECKING, Any

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState, JointState
from std_msgs.msg import Bool
from tf2_msgs.msg import TFMessage

from robot.limits import PICO_RAD_S
from robot.wire.pico import PicoDecoder, Welcome, encode
from tests.ros.devices import mock_robot, set_parameter
from tests.ros.gate import STAMPS, stamped, values
from tests.ros.node_process import NodeProcess
from tests.ros.nodes.test_tof_sonar import Port
from tests.ros.peer import LATCHED, Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

STANDS_POSES = 20
"""At 20 Hz: more than a pause, a driver that was held up goes on after 0.5 s."""


class Stage:
    """The simulated robot, the chassis on it, and what they tell."""

    def __init__(self, domain: int, folder: Path) -> None:
        self.peer = Peer(domain)
        self.robot = mock_robot(domain, folder)
        self.domain, self.port = domain, folder / "pico"
        self.chassis = self.start_chassis()
        self.poses = self.peer.hear("/mock/pose", PoseStamped)
        self.joints = self.peer.hear("/joint_states", JointState)
        self.odometry = self.peer.hear("/odom", Odometry)
        self.told = self.peer.hear("/diagnostics", DiagnosticArray)
        self._timer: Any = None

    def start_chassis(self) -> NodeProcess:
        params = {"port": self.port, "max_age_s": 0.5}
        return NodeProcess("nodes.chassis", self.domain, params=params)

    def close(self) -> None:
        self.chassis.close()
        self.robot.close()
        self.peer.close()

    def drive(self, speed_rad_s: float, steering_rad: float = 0.0) -> None:
        """Command it ten times a second from now on."""
        message = wheels(speed_rad_s, steering_rad)
        publisher = self.peer.publisher("/wheel_commands", JointState)
        self.quiet()
        self._timer = self.peer.node.create_timer(0.1, lambda: publisher.publish(message))

    def quiet(self) -> None:
        if self._timer is not None:
            self.peer.node.destroy_timer(self._timer)
            self._timer = None

    def wait_moving(self, way: int = 1) -> None:
        """Wait until the robot really moves (1 forward, -1 backward)."""
        self.poses.clear()
        wait_until(
            lambda: len(self.poses) > 2 and way * (x_of(self.poses[-1]) - x_of(self.poses[0])) > 0.005,
            "a moving robot",
        )

    def wait_standing(self, poses: int = 6) -> None:
        self.poses.clear()
        wait_until(
            lambda: len(self.poses) > poses and len({*map(x_of, self.poses[-poses:])}) == 1, "a standing robot"
        )

    def assert_stands(self) -> None:
        """See it come to a stand that is no pause."""
        self.wait_standing(STANDS_POSES)

    def wait_told(self, condition: Callable[[DiagnosticStatus, dict[str, str]], bool]) -> None:
        def told() -> bool:
            for message in self.told:
                status = message.status[0]
                if condition(status, {item.key: item.value for item in status.values}):
                    return True
            return False

        self.told.clear()
        wait_until(told, "that state")

    def refused_by_pico(self) -> str:
        """How many lines it says that the Pico has refused."""
        self.told.clear()
        wait_until(lambda: self.told, "its state")
        return values(self.told[0])["refused_by_pico"]


def x_of(message: PoseStamped) -> float:
    return float(message.pose.position.x)


def wheels(speed_rad_s: float, steering_rad: float = 0.0) -> JointState:
    names = ["rear_left_wheel_joint", "rear_right_wheel_joint", "steering_joint"]
    return JointState(
        name=names, position=[math.nan, math.nan, steering_rad], velocity=[speed_rad_s, speed_rad_s, math.nan]
    )


@pytest.fixture(scope="module")
def module_stage(module_domain: int, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Stage]:
    stage = Stage(module_domain, tmp_path_factory.mktemp("chassis"))
    yield stage
    stage.close()


@pytest.fixture
def stage(module_stage: Stage) -> Iterator[Stage]:
    """Everything is well, and the robot stands."""
    module_stage.chassis.wait_for_words("The Pico answers")
    yield module_stage
    module_stage.quiet()
    module_stage.wait_standing()


def test_commands_turn_the_wheels_and_come_back_as_odometry(stage: Stage) -> None:
    transforms = stage.peer.hear("/tf", TFMessage)
    batteries = stage.peer.hear("/battery", BatteryState)
    stage.drive(4.0, 0.2)
    stage.wait_moving()
    stage.joints.clear()
    wait_until(lambda: stage.joints and stage.joints[-1].velocity[0] > 3.9, "the speed asked for")
    joints = stage.joints[-1]
    assert list(joints.name) == list(wheels(0).name)
    assert joints.position[2] == pytest.approx(0.2)
    wait_until(lambda: transforms, "a transform")
    # Told once a second: the first may be of the time before.
    wait_until(lambda: batteries and batteries[-1].current < 0, "a battery that drives motors")
    assert batteries[-1].voltage == pytest.approx(7.4)
    stage.quiet()
    stage.wait_standing()
    real, told = stage.poses[-1].pose.position, stage.odometry[-1].pose.pose.position
    assert (told.x, told.y) == (pytest.approx(real.x, abs=0.03), pytest.approx(real.y, abs=0.03))
    frames = transforms[-1].transforms[0]
    assert (frames.header.frame_id, frames.child_frame_id) == ("odom", "base_link")
    stage.drive(-4.0)
    stage.wait_moving(-1)


def test_silence_and_nonsense_are_a_stop(stage: Stage) -> None:
    stage.drive(3.0)
    stage.wait_moving()
    stage.quiet()
    stage.assert_stands()
    stage.chassis.wait_for_words("No wheel command for 0.5 s")
    stage.drive(-3.0)
    stage.wait_moving(-1)
    stage.drive(math.nan)
    stage.assert_stands()
    stage.chassis.wait_for_words("is not a number")


def test_an_emergency_stop_is_latched_in_the_pico_and_survives_this_node(stage: Stage) -> None:
    stage.drive(3.0)
    stage.wait_moving()
    stage.peer.say("/emergency_stop", Bool(data=True), listeners=2, qos=LATCHED)
    stage.wait_standing()
    stage.wait_told(lambda _status, values: "E" in values.get("flags", ""))
    stage.chassis.send(signal.SIGKILL)
    stage.chassis.close()
    stage.chassis = stage.start_chassis()
    stage.chassis.wait_for_words("The Pico answers", "EMERGENCY STOP")
    stage.assert_stands()
    # Again and again: the killed one still counts as a listener in place of the new one.
    with stage.peer.saying("/emergency_stop", Bool(data=False)):
        stage.wait_told(lambda _status, values: "E" not in values.get("flags", "E"))
    stage.drive(-3.0)
    stage.wait_moving(-1)


def test_a_stop_holds_though_the_pico_is_silent(stage: Stage) -> None:
    stage.drive(3.0)
    stage.wait_moving()
    set_parameter(stage.peer, "mock_robot", "pico", "silent")
    stage.wait_told(lambda status, _values: status.level == DiagnosticStatus.ERROR)
    stage.peer.say("/emergency_stop", Bool(data=True), listeners=2, qos=LATCHED)
    stage.assert_stands()
    set_parameter(stage.peer, "mock_robot", "pico", "fine")
    stage.wait_told(lambda _status, values: "E" in values.get("flags", ""))
    stage.assert_stands()
    with stage.peer.saying("/emergency_stop", Bool(data=False)):
        stage.wait_told(lambda _status, values: "E" not in values.get("flags", "E"))
    stage.drive(-3.0)
    stage.wait_moving(-1)


def test_at_its_end_the_wheels_stand(stage: Stage) -> None:
    stage.drive(random.choice([3.0, -3.0]))
    stage.poses.clear()
    wait_until(lambda: len({x_of(pose) for pose in stage.poses}) > 3, "a moving robot")
    stage.chassis.send(signal.SIGTERM)
    stage.assert_stands()
    assert stage.chassis.wait() == 0
    assert "Traceback" not in stage.chassis.output
    stage.chassis.close()
    stage.chassis = stage.start_chassis()
    stage.chassis.wait_for_words("The Pico answers")


def test_a_cable_is_pulled_and_put_back_and_it_drives_again_by_itself(stage: Stage) -> None:
    stage.drive(-2.0)
    stage.wait_moving(-1)
    set_parameter(stage.peer, "mock_robot", "pico", "unplugged")
    stage.assert_stands()
    stage.chassis.wait_for_words("Lost")
    stage.wait_told(lambda status, _values: status.level == DiagnosticStatus.ERROR)
    set_parameter(stage.peer, "mock_robot", "pico", "fine")
    began = time.monotonic()
    stage.wait_moving(-1)
    assert time.monotonic() - began < 10


@pytest.mark.parametrize("fault", ["noise", "slow"])
def test_noise_and_slowness_do_not_run_away_with_it(stage: Stage, fault: str) -> None:
    set_parameter(stage.peer, "mock_robot", "pico", fault)
    stage.drive(2.0)
    stage.poses.clear()
    wait_until(lambda: len({x_of(pose) for pose in stage.poses}) > 3, "a moving robot")
    wait_until(lambda: max(abs(j.velocity[0]) for j in stage.joints[-50:]) < 2.5, "no faster")
    stage.drive(0.0)
    stage.wait_standing()
    set_parameter(stage.peer, "mock_robot", "pico", "fine")
    stage.wait_told(lambda status, _values: status.level == DiagnosticStatus.OK)


# ---------------------------------------------------------------- beyond the limits


def test_it_refuses_what_is_beyond_the_limits(stage: Stage) -> None:
    motors = stage.peer.hear("/mock/motors", JointState)
    for speed, steering, words in (
        (200.0, 0.0, "200 rad/s, limit 17.9"),
        (-1e308, 0.0, "-1e+308 rad/s, limit 17.9"),
        (3.0, 1.2, "1.2 rad, limit 0.5 rad"),
        (math.nan, 0.0, "nan rad/s, limit 17.9"),
    ):
        stage.drive(3.0)
        stage.wait_moving()
        stage.drive(speed, steering)
        stage.wait_told(
            lambda status, values, words=words: (  # type: ignore[misc]
                values.get("refused", "").startswith(words) and status.level != DiagnosticStatus.OK
            )
        )
        stage.assert_stands()
        stage.drive(-3.0)
        stage.wait_moving(-1)
        stage.quiet()
        stage.wait_standing()
    stage.chassis.wait_for_words("[ERROR]", "/wheel_commands", "refused")
    # The controller of a wheel swings a little beyond what it was told.
    assert max(abs(one) for told in motors for one in told.effort[:2]) <= 3.0


def test_it_refuses_stamps_as_the_gate_does(stage: Stage) -> None:
    for since_s, words in STAMPS:
        with stage.peer.saying("/wheel_commands", stamped(wheels(3.0), since_s)):
            stage.chassis.wait_for_words(words)
    stage.assert_stands()
    publisher = stage.peer.publisher("/wheel_commands", JointState)
    stage.poses.clear()
    for _ in range(5):
        publisher.publish(stamped(wheels(3.0), 0.0))
    wait_until(lambda: len({x_of(pose) for pose in stage.poses}) > 1, "a fresh one is obeyed")


def test_whatever_is_asked_the_pico_is_never_sent_more_than_it_takes(stage: Stage) -> None:
    """The firmware would refuse it, and count; so would this test."""
    dice = random.Random(8)
    kinds = (0.0, 1.0, 17.9, 17.90602, 18.0, 200.0, 1e5, 1e30, 1e308, math.inf, math.nan)
    angles = (0.0, 0.1, 0.5, 0.50001, 1.57, 1e30, math.nan)
    motors = stage.peer.hear("/mock/motors", JointState)
    before = stage.refused_by_pico()
    publisher = stage.peer.publisher("/wheel_commands", JointState)
    wait_until(publisher.get_subscription_count, "a subscription")
    for _ in range(300):
        message = wheels(0.0, dice.choice(angles) * dice.choice((-1, 1)))
        speeds = (dice.choice(kinds) * dice.choice((-1, 1)) for _side in range(2))
        message.velocity = [*speeds, math.nan]
        publisher.publish(message)
        # A pace, and no synchronisation: the queue is ten long, and the device has 4 KiB, of which
        # a second's worth is to be enough where it is held up. A line cut short would be refused.
        time.sleep(0.007)
    stage.drive(-2.0)
    stage.wait_moving(-1)
    assert max(abs(one) for told in motors for one in told.effort[:2]) <= PICO_RAD_S
    assert stage.refused_by_pico() == before


# ---------------------------------------------------------------- ports of others


@pytest.fixture
def port(tmp_path: Path) -> Iterator[Port]:
    port = Port(tmp_path / "pico")
    yield port
    port.unplug()


def test_a_pico_of_another_protocol_is_told(ros_domain: int, port: Port) -> None:
    with NodeProcess("nodes.chassis", ros_domain, params={"port": port.path}) as chassis:
        chassis.wait_for_words("Connected")

        def complained() -> bool:
            port.send(encode(Welcome(0, 9, "2.0")))
            return "speaks protocol 9" in chassis.output

        wait_until(complained, "a complaint", every_s=0.1)
        assert port.ends is not None
        heard = PicoDecoder().feed(os.read(port.ends[0], 4096))
        assert heard
        assert not any(getattr(message, "left_rad_s", 0) for message in heard)

"""The gate among several sources, near obstacles, and when it is started, stopped and held up."""

from __future__ import annotations

import signal
import time
from typing import TYPE_CHECKING

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float32

from tests.ros.devices import set_parameter
from tests.ros.gate import FRONT, Gate, drive, values
from tests.ros.node_process import NodeProcess
from tests.ros.peer import LATCHED, Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

KEYS, ACTION, WORDS = "/drive_teleop", "/drive_action", "/drive"


@pytest.fixture
def gate(ros_domain: int, request: pytest.FixtureRequest) -> Iterator[Gate]:
    with Gate(ros_domain, **getattr(request, "param", {})) as gate:
        yield gate


def speeds(heard: list[AckermannDriveStamped]) -> set[float]:
    return {round(message.drive.speed, 3) for message in heard}


def let_pass(seconds: float) -> None:
    """Let a time pass that the node counts by its own clock."""
    end_s = time.monotonic() + seconds
    wait_until(lambda: time.monotonic() > end_s, "the end of a pause", within_s=seconds + 30)


# ---------------------------------------------------------------- who drives


@pytest.mark.parametrize("gate", [{"max_age_s": 1.0}], indirect=True)
def test_keys_rank_over_the_action_and_that_over_words(gate: Gate) -> None:
    gate.see(float("inf"))
    words = gate.repeat(WORDS, drive(0.3))
    gate.wait_for_speed(0.3)
    action = gate.repeat(ACTION, drive(0.2))
    gate.wait_for_speed(0.2)
    gate.process.wait_for_words("/drive is ignored: /drive_action drives, and ranks higher")
    keys = gate.repeat(KEYS, drive(0.1))
    gate.wait_for_speed(0.1)
    wait_until(lambda: values(gate.states[-1])["source"] == KEYS, "the source in the state")
    state = values(gate.states[-1])
    assert state["ignored"] in (ACTION, WORDS)
    assert (state["allowed"], state["verdict"]) == ("1.00", "free")
    assert 0 <= float(state["command_age_s"]) < 1
    assert f"is ignored: {KEYS} drives" in gate.states[-1].status[0].message

    words.cancel()
    action.cancel()
    let_pass(1.1)
    gate.safe.clear()
    keys.cancel()
    gate.wait_for_speed(0.0)
    assert speeds(gate.safe) <= {0.0, 0.1}, "what words and action said before is over"
    wait_until(lambda: values(gate.states[-1])["source"] == "", "nobody in the state")
    gate.process.wait_for_words("No new command for 0.5 s: stop")


@pytest.mark.parametrize("gate", [{"sources": "/b,/a"}], indirect=True)
def test_the_sources_are_a_parameter(gate: Gate) -> None:
    gate.peer.say("/a", drive(-0.1))
    gate.wait_for_speed(-0.1)
    gate.peer.say("/b", drive(-0.2))
    gate.wait_for_speed(-0.2)
    gate.peer.say("/a", drive(-0.1))
    gate.process.wait_for_words("/a is ignored")
    assert gate.peer.node.count_subscribers("/drive") == 0


# ---------------------------------------------------------------- slowing down


def test_it_slows_down_in_proportion_and_is_fast_again_after(gate: Gate) -> None:
    gate.see(float("inf"))
    gate.peer.say("/drive", drive(0.4, 0.2))
    gate.wait_for_speed(0.4)
    for distance, speed, share in ((0.75, 0.2, "0.50"), (0.6, 0.08, "0.20"), (1.0, 0.4, "1.00")):
        gate.peer.say(FRONT, Float32(data=distance))
        passed = gate.wait_for_speed(speed)
        assert passed.drive.steering_angle == pytest.approx(0.2)
        wait_until(
            lambda share=share: values(gate.states[-1])["allowed"] == share,  # type: ignore[misc]
            f"{share} in the state",
        )
        sentence = gate.states[-1].status[0].message
        assert ("slowed to 20 %: front 0.60 m" in sentence) == (distance == 0.6)
        assert gate.states[-1].status[0].level == b"\0"
    gate.see(0.6)
    gate.peer.say("/drive", drive(-0.4))
    gate.wait_for_speed(-0.4)


# ---------------------------------------------------------------- starts and ends


def test_a_gate_that_died_comes_back_to_the_stop_that_is_on(gate: Gate) -> None:
    """The stop is latched by who gave it; a release from before is none."""
    with Peer(int(gate.peer.node.context.get_domain_id()), "another") as other:
        other.say("/emergency_stop", Bool(data=False), qos=LATCHED)
        gate.repeat(FRONT, Float32(data=3.0))
        gate.repeat(KEYS, drive(0.3))
        gate.wait_for_speed(0.3)
        gate.peer.say("/emergency_stop", Bool(data=True), qos=LATCHED)
        gate.wait_for_speed(0.0)
        gate.process.send(signal.SIGKILL)
        gate.process.wait()
        gate.safe.clear()
        gate.states.clear()
        # A latched word that is lost on its way is said again within 3 s.
        gate.restart(settle_s=4.0)
        gate.wait_for_state("emergency_stop")
        let_pass(4.2)
        assert values(gate.states[-1])["verdict"] == "emergency_stop"
        assert speeds(gate.safe) == {0.0}
        with other.saying("/emergency_stop", Bool(data=False)):
            gate.wait_for_speed(0.3)


def test_starting_and_ending_never_turns_a_wheel(gate: Gate, ros_domain: int) -> None:
    """A command from before the start is none, and all that dies leaves standing wheels behind."""
    params: dict[str, object] = {"drive_topic": "/drive_safe", "max_age_s": 0.5, "rate": 20}
    old = QoSProfile(depth=1, durability=LATCHED.durability)
    for topic in (KEYS, WORDS, "/drive_safe"):
        gate.peer.publisher(topic, AckermannDriveStamped, old).publish(drive(0.3))
    gate.repeat(FRONT, Float32(data=3.0))
    with NodeProcess("nodes.electronic_differential", ros_domain, params=params):
        wheels = gate.peer.hear("/wheel_commands", JointState)
        gate.restart(max_age_s=0.5)
        gate.wait_for_state("free")
        wait_until(lambda: len(wheels) >= 20, "wheel commands of the first second")
        assert turns(wheels) == 0
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGKILL):
            keys = gate.repeat(KEYS, drive(0.3))
            wait_until(lambda: turns(wheels) > 5, "turning wheels")
            gate.process.send(number)
            gate.process.wait()
            wait_until(lambda: turns(wheels[-5:]) == 0, f"standing wheels after {number!r}")
            wheels.clear()
            keys.cancel()
            gate.states.clear()
            gate.restart()
            gate.wait_for_state("free")
            wait_until(lambda: len(wheels) >= 10, "wheel commands after a new start")
            assert turns(wheels) == 0


def turns(wheels: list[JointState]) -> int:
    """How many of these commands turn a wheel."""
    return sum(any(speed for speed in message.velocity[:2]) for message in wheels)


@pytest.mark.parametrize("gate", [{"max_age_s": 0.5}], indirect=True)
def test_a_gate_that_was_held_up_obeys_nothing_that_has_waited(gate: Gate) -> None:
    gate.see(3.0)
    keys = gate.repeat(KEYS, drive(0.3))
    gate.wait_for_speed(0.3)
    gate.process.send(signal.SIGSTOP)
    let_pass(0.2)
    keys.cancel()
    let_pass(1.5)
    gate.safe.clear()
    gate.process.send(signal.SIGCONT)
    let_pass(0.8)
    assert len(gate.safe) >= 10, "what passes after it"
    # The first may be the word that it was just saying.
    assert speeds(gate.safe[1:]) == {0.0}
    gate.process.wait_for_words("was held up")
    gate.repeat(KEYS, drive(0.2))
    gate.wait_for_speed(0.2)


def test_a_gate_that_is_held_up_while_it_takes_a_command_in_does_not_obey_it(
    ros_domain: int,
) -> None:
    with Gate(ros_domain, module="tests.ros.drowsy_gate", max_age_s=0.5) as gate:
        gate.see(3.0)
        gate.peer.say(KEYS, drive(0.3))
        gate.process.wait_for_words("was held up")
        seen = len(gate.safe)
        wait_until(lambda: len(gate.safe) >= seen + 10, "what passes after it")
        assert speeds(gate.safe) == {0.0}


def test_it_tells_its_distances_and_a_new_one_at_once(gate: Gate) -> None:
    gate.see(2.0)
    state = values(gate.states[-1])
    assert (state["critical_m"], state["slow_m"]) == ("0.5", "1")
    set_parameter(gate.peer, "safety_node", "critical_distance", 0.75)
    wait_until(lambda: values(gate.states[-1])["critical_m"] == "0.75", "the new distance")

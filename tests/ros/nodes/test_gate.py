"""The gate: warns, slows, blocks, stops, ranks, refuses what makes no sense, and says why."""

from __future__ import annotations

import math
import signal
import time
from typing import TYPE_CHECKING, Any

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.qos import QoSProfile, qos_profile_sensor_data
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float32

from nodes.parts.node import TranslatedLogger
from nodes.safety.state import DistanceSensor, GateSnapshot
from nodes.safety.words import diagnosis, tell_front
from robot.safety.distance import SafetyZone, Verdict
from tests.ros.gate import BEYOND, FRONT, REAR, STAMPS, Gate, drive, stamped, values
from tests.ros.node_process import NodeProcess
from tests.ros.node_thread import NodeThread
from tests.ros.nodes.test_driver_parts import Log
from tests.ros.peer import LATCHED, Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator

KEYS, ACTION, WORDS = "/drive_teleop", "/drive_action", "/drive"
APART = {"apart": "nodes.safety_stop"}


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


# ---------------------------------------------------------------- obstacles


def test_danger_ahead_stops_the_robot_and_lets_it_back_off(gate: Gate) -> None:
    for distance in (0.49, 0.0, -math.inf, math.nan, -1.0):
        gate.see(2.0)
        gate.wait_for_state("free")
        gate.peer.say("/drive", drive(0.3, 0.5))
        passed = gate.wait_for_speed(0.3)
        assert passed.drive.steering_angle == pytest.approx(0.5)
        gate.see(distance)
        gate.wait_for_speed(0.0)
        assert gate.wait_for_state("blocked_forward").level > DiagnosticStatus.OK
        gate.peer.say("/drive", drive(-0.3))
        gate.wait_for_speed(-0.3)


def test_a_command_cut_short_is_not_resumed(gate: Gate) -> None:
    gate.see(2.0)
    gate.peer.say("/drive", drive(0.3))
    gate.wait_for_speed(0.3)
    gate.see(0.2)
    gate.wait_for_speed(0.0)
    gate.process.wait_for_words("is stopped: forward is blocked: front 0.20 m")
    gate.see(2.0)
    gate.wait_for_state("free")
    gate.wait_for_speed(0.0)


@pytest.mark.parametrize("gate", [{"stale_after_s": 0.3}], indirect=True)
def test_silence_is_danger(gate: Gate) -> None:
    gate.peer.say("/drive", drive(0.3))
    gate.process.wait_for_words("is stopped")
    with gate.peer.saying(FRONT, Float32(data=2.0)):
        gate.wait_for_state("free")
    state = gate.wait_for_state("blocked_forward")
    assert state.level == DiagnosticStatus.ERROR
    assert "silent" in state.message
    gate.wait_for_speed(0.0)
    gate.process.wait_for_words("silent for")


@pytest.mark.parametrize("gate", [{"rear_topic": REAR}], indirect=True)
def test_a_rear_sonar_blocks_the_way_back(gate: Gate) -> None:
    gate.peer.publisher(REAR, Float32, qos_profile_sensor_data)
    gate.see(2.0)
    gate.see(0.1, "rear")
    gate.wait_for_state("blocked_backward")
    gate.peer.say("/drive", drive(-0.3))
    gate.process.wait_for_words("is stopped: backward is blocked: rear 0.10 m")
    gate.see(0.1)
    gate.wait_for_state("blocked")


def test_a_reliable_sonar_is_heard_beside_and_after_one_of_best_effort(gate: Gate) -> None:
    gate.see(2.0)
    with Peer(int(gate.peer.node.context.get_domain_id()), "other") as other:
        quick = other.publisher(FRONT, Float32, qos_profile_sensor_data)
        with other.saying(FRONT, Float32(data=1.5)):
            wait_until(quick.get_subscription_count, "the gate by best effort")
            gate.see(0.75)
    gate.see(2.5)


@pytest.mark.parametrize("gate", [{"stale_after_s": 0.5}], indirect=True)
def test_of_two_sonars_the_one_that_speaks_too_rarely_is_named(gate: Gate, ros_domain: int) -> None:
    """A forgotten mock at 0.7 Hz came beside the real sonar: not the front sonar is silent."""
    with gate.peer.saying(FRONT, Float32(data=2.0), 0.05):
        gate.wait_for_state("free")
        gate.states.clear()
        wait_until(lambda: len(gate.states) > 3, "that it has been alone for a while")
        with Peer(ros_domain, "forgotten") as forgotten, forgotten.saying(FRONT, Float32(data=9.0), 1.4):
            wait_until(lambda: values(gate.states[-1])["front_too_rare"] == "/forgotten", "its name")
            gate.wait_for_state("blocked_forward")
            gate.process.wait_for_words("/forgotten speaks too rarely")


def test_it_slows_down_in_proportion_and_is_fast_again_after(gate: Gate) -> None:
    gate.see(math.inf)
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
        assert gate.states[-1].status[0].level == DiagnosticStatus.OK
    gate.see(0.6)
    gate.peer.say("/drive", drive(-0.4))
    gate.wait_for_speed(-0.4)


def test_without_the_gate_it_only_warns_and_does_not_flood_the_log(peer: Peer, ros_domain: int) -> None:
    with NodeThread("nodes.safety_stop", ros_domain, lang="ru") as node:
        peer.say(FRONT, Float32(data=1.25))
        node.wait_for_words("Путь свободен (1,25 м)")
        for _ in range(200):
            peer.say(FRONT, Float32(data=1.25))
        peer.say(FRONT, Float32(data=0.31))
        node.wait_for_words("[WARN]", "Препятствие в 0,31 м")
        assert node.output.count("Путь свободен") <= 10
        assert peer.node.count_publishers("/drive_safe") == 0


@pytest.mark.parametrize(
    ("lang", "metres", "stopped", "logged", "told"),
    [
        ("en", -math.inf, False, "Obstacle too close to measure.", "front too close to measure"),
        ("ru", -math.inf, False, "Препятствие слишком близко.", "спереди слишком близко"),
        ("en", math.inf, False, "The path is clear (nothing in range).", "motion is allowed"),
        ("ru", math.inf, False, "Путь свободен (преград не видно).", "движение разрешено"),
        ("en", 0.501, False, "Free to move, slowed to 1 % (0.50 m).", ""),
        ("ru", 0.52, False, "Ехать можно, но медленнее: 4 % скорости (0,52 м).", ""),
        ("en", 0.5, False, "EMERGENCY BRAKE! Obstacle at 0.50 m.", ""),
        ("en", 0.61, True, "0.61 m ahead; the emergency stop holds the wheels.", ""),
        ("ru", 0.61, True, "Впереди 0,61 м; колёса держит аварийный стоп.", ""),
        ("en", math.inf, True, "Nothing in range ahead; the emergency stop holds the wheels.", ""),
    ],
)
def test_what_is_ahead_is_told_in_words(lang: str, metres: float, stopped: bool, logged: str, told: str) -> None:
    log, zone = Log(), SafetyZone(0.5, 1.0, 60.0)
    say = TranslatedLogger(log, lang)  # type: ignore[arg-type]
    sensor = DistanceSensor("front")
    sensor.see(metres)
    result = sensor.result(zone)
    tell_front(say, result, stopped=stopped)
    assert log.lines[-1].endswith(logged)
    if told:
        verdict = Verdict.FREE if metres > 0 else Verdict.BLOCKED_FORWARD
        assert diagnosis(say, verdict, [result], GateSnapshot(), zone).message.endswith(told)


# ---------------------------------------------------------------- who drives


@pytest.mark.parametrize("gate", [{"max_age_s": 1.0}], indirect=True)
def test_keys_rank_over_the_action_and_that_over_words(gate: Gate) -> None:
    gate.see(math.inf)
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

    words.cancel()
    action.cancel()
    let_pass(1.1)
    gate.safe.clear()
    keys.cancel()
    gate.wait_for_speed(0.0)
    assert speeds(gate.safe) <= {0.0, 0.1}, "what words and action said before is over"
    wait_until(lambda: values(gate.states[-1])["source"] == "", "nobody in the state")
    gate.process.wait_for_words("No new command for 0.5 s: stop")


# ---------------------------------------------------------------- beyond the limits


def refused_by(gate: Gate) -> str:
    """What the newest /safety_state says of a command that was refused."""
    return values(gate.states[-1]).get("refused", "") if gate.states else ""


def test_it_refuses_what_is_beyond_the_limits(gate: Gate) -> None:
    gate.see(math.inf)
    for speed, steering, words in BEYOND:
        gate.peer.say("/drive", drive(0.2))
        gate.wait_for_speed(0.2)
        gate.peer.say("/drive", drive(speed, steering))
        wait_until(lambda: gate.safe[-1].drive.speed == 0, "a stop")
        wait_until(lambda words=words: refused_by(gate) == words, f"{words} on /safety_state")  # type: ignore[misc]
        status = gate.states[-1].status[0]
        assert status.level == DiagnosticStatus.WARN
        assert "refused" in status.message
        # The last may be one that was on its way from the command before.
        assert speeds(gate.safe) <= {0.0, 0.2, -0.5}
        gate.peer.say("/drive", drive(-0.5, 0.5))
        gate.wait_for_speed(-0.5)
        wait_until(lambda: not refused_by(gate), "a state without it")
    gate.process.wait_for_words("[ERROR]", "/drive", "refused")


@pytest.mark.parametrize("gate", [{"max_age_s": 0.5}, {"max_age_s": 0.0}], indirect=True, ids=str)
def test_it_refuses_stamps_of_long_ago_and_of_other_clocks(gate: Gate) -> None:
    gate.see(math.inf)
    gate.safe.clear()
    for since_s, words in STAMPS:
        with gate.peer.saying("/drive", stamped(drive(0.3), since_s)):
            gate.process.wait_for_words(words)
            wait_until(lambda: "stamp" in refused_by(gate), "a word on /safety_state")
    gate.peer.say("/drive", stamped(drive(0.1), 0.0))
    wait_until(lambda: any(one.drive.speed for one in gate.safe), "a fresh one")
    assert speeds(gate.safe) <= {0.0, 0.1}


# ---------------------------------------------------------------- stops


@pytest.mark.parametrize("qos", [LATCHED, 10], ids=["latched", "volatile"])
def test_an_emergency_stop_holds_until_it_is_released(gate: Gate, qos: Any) -> None:
    gate.see(2.0)
    gate.peer.say("/drive", drive(0.3))
    gate.wait_for_speed(0.3)
    gate.peer.say("/emergency_stop", Bool(data=True), qos=qos)
    gate.wait_for_speed(0.0)
    assert gate.wait_for_state("emergency_stop").level == DiagnosticStatus.ERROR
    gate.safe.clear()
    gate.peer.say("/drive", drive(-0.3))
    gate.process.wait_for_words("-0.30 m/s, 0.00 rad is stopped")
    wait_until(lambda: len(gate.safe) > 20, "what passes during the stop")
    gate.peer.say("/emergency_stop", Bool(data=False), qos=qos)
    gate.wait_for_state("free")
    assert speeds(gate.safe) == {0.0}
    gate.peer.say("/drive", drive(-0.2))
    gate.wait_for_speed(-0.2)


def test_a_stop_from_before_the_node_started_is_obeyed(peer: Peer, ros_domain: int) -> None:
    peer.publisher("/emergency_stop", Bool, LATCHED).publish(Bool(data=True))
    with NodeThread("nodes.safety_stop", ros_domain) as node:
        node.wait_for_words("EMERGENCY STOP")


@pytest.mark.parametrize("gate", [{"max_age_s": 0.3}], indirect=True)
def test_a_command_that_is_not_renewed_becomes_a_stop(gate: Gate) -> None:
    gate.see(2.0)
    gate.safe.clear()
    gate.peer.say("/drive", drive(-0.3))
    # It may have become a stop again by the time that this test looks.
    wait_until(lambda: any(passed.drive.speed < 0 for passed in gate.safe), "the command")
    gate.wait_for_speed(0.0)
    gate.process.wait_for_words("No new command for 0.3 s")


@pytest.mark.parametrize("gate", [{"max_age_s": 0}], indirect=True)
def test_a_stop_is_obeyed_whatever_its_stamp(gate: Gate) -> None:
    """With `max_age_s` 0 nothing else would end the drive."""
    gate.see(math.inf)
    for since_s in (-10.0, -1e6, 1e6):
        gate.peer.say("/drive", drive(0.3))
        gate.wait_for_speed(0.3)
        gate.peer.say("/drive", stamped(drive(0.0), since_s))
        gate.wait_for_speed(0.0)


# ---------------------------------------------------------------- starts, ends, and hangs


@pytest.mark.parametrize("gate", [APART], indirect=True)
def test_a_gate_that_died_comes_back_to_the_stop_that_is_on(gate: Gate) -> None:
    """The stop is latched by who gave it; a release from before is none."""
    with Peer(int(gate.peer.node.context.get_domain_id()), "another") as other:
        other.say("/emergency_stop", Bool(data=False), qos=LATCHED)
        gate.repeat(FRONT, Float32(data=3.0))
        gate.repeat(KEYS, drive(0.3))
        gate.wait_for_speed(0.3)
        gate.peer.say("/emergency_stop", Bool(data=True), qos=LATCHED)
        gate.wait_for_speed(0.0)
        gate.send(signal.SIGKILL)
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


@pytest.mark.parametrize("gate", [APART], indirect=True)
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
            gate.send(number)
            wait_until(lambda: turns(wheels[-5:]) == 0, f"standing wheels after {number!r}")
            if number != signal.SIGKILL:
                wait_until(lambda: gate.safe[-1].drive.speed == 0.0, "a last stop of the gate's")
            wheels.clear()
            keys.cancel()
            gate.states.clear()
            gate.restart()
            gate.wait_for_state("free")
            wait_until(lambda: len(wheels) >= 10, "wheel commands after a new start")
            assert turns(wheels) == 0


def turns(wheels: list[JointState]) -> int:
    return sum(any(speed for speed in message.velocity[:2]) for message in wheels)


@pytest.mark.parametrize("gate", [{**APART, "max_age_s": 0.5}], indirect=True)
def test_a_gate_that_was_held_up_obeys_nothing_that_has_waited(gate: Gate) -> None:
    gate.see(3.0)
    keys = gate.repeat(KEYS, drive(0.3))
    gate.wait_for_speed(0.3)
    gate.send(signal.SIGSTOP)
    let_pass(0.2)
    keys.cancel()
    let_pass(1.5)
    gate.safe.clear()
    gate.send(signal.SIGCONT)
    let_pass(0.8)
    assert len(gate.safe) >= 10, "what passes after it"
    # The first may be the word that it was just saying.
    assert speeds(gate.safe[1:]) == {0.0}
    gate.process.wait_for_words("was held up")
    gate.repeat(KEYS, drive(0.2))
    gate.wait_for_speed(0.2)


@pytest.mark.parametrize("gate", [{"apart": "tests.ros.drowsy_gate", "max_age_s": 0.5}], indirect=True)
def test_a_gate_that_is_held_up_while_it_takes_a_command_in_does_not_obey_it(gate: Gate) -> None:
    gate.see(3.0)
    gate.peer.say(KEYS, drive(0.3))
    gate.process.wait_for_words("was held up")
    seen = len(gate.safe)
    wait_until(lambda: len(gate.safe) >= seen + 10, "what passes after it")
    assert speeds(gate.safe) == {0.0}

"""The reflex: warns, blocks, stops, and says why; the mock sonar that feeds it."""

from __future__ import annotations

import itertools
import math
import signal
from typing import TYPE_CHECKING, Any

import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from std_msgs.msg import Bool, Float32

from nodes.parts.translated_logger import TranslatedLogger
from nodes.safety.distance_sensors import DistanceSensor
from nodes.safety.snapshot import GateSnapshot
from nodes.safety.words import diagnosis, tell_front
from robot.safety.distance import RangeState, SafetyZone, Verdict
from tests.ros.gate import FRONT, REAR, Gate, drive, values
from tests.ros.node_process import NodeProcess
from tests.ros.nodes.test_serial_link import Log
from tests.ros.peer import LATCHED, Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator


@pytest.fixture
def gate(ros_domain: int, request: pytest.FixtureRequest) -> Iterator[Gate]:
    gate = Gate(ros_domain, **getattr(request, "param", {}))
    yield gate
    gate.close()


def test_a_free_way_lets_every_command_through_unchanged(gate: Gate) -> None:
    gate.see(2.0)
    gate.peer.say("/drive", drive(0.3, 0.5))
    passed = gate.wait_for_speed(0.3)
    assert passed.drive.steering_angle == pytest.approx(0.5)
    assert passed.header.frame_id == "base_link"
    state = gate.wait_for_state("free")
    assert state.level == DiagnosticStatus.OK
    assert values(gate.states[-1])["front_m"] == "2.000"


def test_danger_ahead_stops_the_robot_and_lets_it_back_off(gate: Gate) -> None:
    for distance in (0.49, 0.0, -math.inf, math.nan, -1.0):
        gate.see(2.0)
        gate.wait_for_state("free")
        gate.peer.say("/drive", drive(0.3))
        gate.wait_for_speed(0.3)
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
    with gate.peer.saying(FRONT, Float32(data=2.0)):
        gate.wait_for_state("free")
    state = gate.wait_for_state("blocked_forward")
    assert state.level == DiagnosticStatus.ERROR
    assert "silent" in state.message
    gate.wait_for_speed(0.0)
    gate.process.wait_for_words("silent for")


def test_without_any_reading_the_robot_does_not_drive_forward(gate: Gate) -> None:
    gate.peer.say("/drive", drive(0.3))
    gate.process.wait_for_words("is stopped")
    gate.wait_for_speed(0.0)


@pytest.mark.parametrize("gate", [{"rear_topic": REAR}], indirect=True)
def test_a_rear_sonar_blocks_the_way_back(gate: Gate) -> None:
    gate.see(2.0)
    gate.see(0.1, "rear")
    gate.wait_for_state("blocked_backward")
    gate.peer.say("/drive", drive(-0.3))
    gate.process.wait_for_words("is stopped: backward is blocked: rear 0.10 m")
    gate.see(0.1)
    gate.wait_for_state("blocked")


def test_a_stop_is_not_told_as_cut(gate: Gate) -> None:
    gate.see(2.0)
    gate.peer.say("/emergency_stop", Bool(data=True), qos=LATCHED)
    gate.wait_for_state("emergency_stop")
    gate.peer.say("/drive", drive(0.0, 0.2))
    gate.peer.say("/drive", drive(0.1, 0.2))
    gate.process.wait_for_words("0.10 m/s, 0.20 rad is stopped")
    assert "The command 0.00 m/s" not in gate.process.output


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
    wait_until(lambda: len(gate.safe) > 20, "what passes during the stop")
    gate.peer.say("/emergency_stop", Bool(data=False), qos=qos)
    gate.wait_for_state("free")
    assert {message.drive.speed for message in gate.safe} == {0.0}
    gate.peer.say("/drive", drive(-0.2))
    gate.wait_for_speed(-0.2)


def test_a_stop_from_before_the_node_started_is_obeyed(ros_domain: int) -> None:
    with Peer(ros_domain) as peer:
        peer.publisher("/emergency_stop", Bool, LATCHED).publish(Bool(data=True))
        with NodeProcess("nodes.safety_stop", ros_domain) as process:
            process.wait_for_words("EMERGENCY STOP")


@pytest.mark.parametrize("gate", [{"max_age_s": 0.3}], indirect=True)
def test_a_command_that_is_not_renewed_becomes_a_stop(gate: Gate) -> None:
    gate.see(2.0)
    gate.safe.clear()
    gate.peer.say("/drive", drive(-0.3))
    # It may have become a stop again by the time that this test looks.
    wait_until(lambda: any(passed.drive.speed < 0 for passed in gate.safe), "the command")
    gate.wait_for_speed(0.0)
    gate.process.wait_for_words("No new command for 0.3 s")


def test_a_speed_that_is_no_number_is_a_stop(gate: Gate) -> None:
    gate.see(2.0)
    for speed in (math.nan, math.inf, -math.inf):
        gate.peer.say("/drive", drive(-0.3))
        gate.wait_for_speed(-0.3)
        gate.peer.say("/drive", drive(speed))
        gate.wait_for_speed(0.0)


def test_the_gate_leaves_a_stop_behind_when_it_ends(gate: Gate) -> None:
    gate.see(2.0)
    gate.peer.say("/drive", drive(-0.3))
    gate.wait_for_speed(-0.3)
    gate.process.send(signal.SIGINT)
    wait_until(lambda: gate.safe[-1].drive.speed == 0.0, "a last stop")


def test_without_the_gate_it_only_warns(ros_domain: int) -> None:
    with Peer(ros_domain) as peer, NodeProcess("nodes.safety_stop", ros_domain, lang="ru") as node:
        peer.say(FRONT, Float32(data=1.25))
        node.wait_for_words("Путь свободен (1,25 м)")
        peer.say(FRONT, Float32(data=0.31))
        node.wait_for_words("[WARN]", "Препятствие в 0,31 м")
        assert peer.node.count_publishers("/drive_safe") == 0


def test_a_fast_sonar_does_not_flood_the_log(ros_domain: int) -> None:
    with Peer(ros_domain) as peer, NodeProcess("nodes.safety_stop", ros_domain) as node:
        peer.say(FRONT, Float32(data=1.0))
        node.wait_for_words("is clear")
        for _ in range(200):
            peer.say(FRONT, Float32(data=1.0))
        peer.say(FRONT, Float32(data=0.1))
        node.wait_for_words("Obstacle at 0.10 m")
        assert node.output.count("is clear") <= 10


@pytest.mark.parametrize(
    ("lang", "metres", "logged", "told"),
    [
        ("en", -math.inf, "Obstacle too close to measure.", "front too close to measure"),
        ("ru", -math.inf, "Препятствие слишком близко.", "спереди слишком близко"),
        ("en", math.inf, "The path is clear (nothing in range).", "motion is allowed"),
        ("ru", math.inf, "Путь свободен (преград не видно).", "движение разрешено"),
    ],
)
def test_what_is_out_of_range_is_told_in_words(
    lang: str, metres: float, logged: str, told: str
) -> None:
    log = Log()
    say = TranslatedLogger(log, lang)  # type: ignore[arg-type]
    sensor = DistanceSensor("front")
    sensor.see(metres)
    zone = SafetyZone(0.5, 1.0, 60.0)
    result = sensor.result(zone)
    tell_front(say, result)
    assert log.lines[-1].endswith(logged)
    verdict = Verdict.FREE if metres > 0 else Verdict.BLOCKED_FORWARD
    assert diagnosis(say, verdict, [result], GateSnapshot(), zone).message.endswith(told)
    slowed = diagnosis(say, Verdict.FREE, [result], GateSnapshot(allowed=0.5), zone).message
    assert "inf" not in slowed


@pytest.mark.parametrize(
    ("lang", "metres", "logged"),
    [
        ("en", 0.52, "Free to move, slowed to 4 % (0.52 m)."),
        ("ru", 0.52, "Ехать можно, но медленнее: 4 % скорости (0,52 м)."),
        ("en", 0.501, "Free to move, slowed to 1 % (0.50 m)."),
        ("en", 0.999, "Free to move, slowed to 99 % (1.00 m)."),
        ("en", 0.5, "EMERGENCY BRAKE! Obstacle at 0.50 m."),
        ("en", 1.0, "The path is clear (1.00 m)."),
    ],
)
def test_a_way_on_which_it_is_slowed_is_not_called_free(
    lang: str, metres: float, logged: str
) -> None:
    log = Log()
    sensor = DistanceSensor("front")
    sensor.see(metres)
    tell_front(TranslatedLogger(log, lang), sensor.result(SafetyZone(0.5, 1.0, 60.0)))  # type: ignore[arg-type]
    assert log.lines[-1].endswith(logged)


@pytest.mark.parametrize(
    ("lang", "metres", "logged"),
    [
        ("en", 0.61, "0.61 m ahead; the emergency stop holds the wheels."),
        ("ru", 0.61, "Впереди 0,61 м; колёса держит аварийный стоп."),
        ("en", 2.0, "2.00 m ahead; the emergency stop holds the wheels."),
        ("en", math.inf, "Nothing in range ahead; the emergency stop holds the wheels."),
    ],
)
def test_nothing_is_called_free_to_move_during_an_emergency_stop(
    lang: str, metres: float, logged: str
) -> None:
    log = Log()
    sensor = DistanceSensor("front")
    sensor.see(metres)
    result = sensor.result(SafetyZone(0.5, 1.0, 60.0))
    tell_front(TranslatedLogger(log, lang), result, stopped=True)  # type: ignore[arg-type]
    assert log.lines[-1].endswith(logged)


@pytest.mark.parametrize(("slow_m", "state"), [(1.0, RangeState.CLOSE), (0.0, RangeState.FREE)])
def test_where_slowing_has_come_to_nothing_the_way_is_not_free(
    slow_m: float, state: RangeState
) -> None:
    sensor = DistanceSensor("front")
    sensor.see(0.5)
    assert sensor.result(SafetyZone(0.5, slow_m, 60.0)).state == state


# ---------------------------------------------------------------- the sonar


def heard_from_sonar(domain: int, count: int, **params: object) -> list[float]:
    with (
        Peer(domain) as peer,
        NodeProcess("nodes.mock_sonar", domain, params={"rate": 200, **params}),
    ):
        heard = peer.hear(FRONT, Float32)
        wait_until(lambda: len(heard) >= count, f"{count} readings")
        return [message.data for message in heard]


def test_the_random_sonar_stays_in_the_course_s_range(ros_domain: int) -> None:
    distances = heard_from_sonar(ros_domain, 100)
    assert all(0.2 <= distance <= 3.0 for distance in distances)
    assert len(set(distances)) > 50


def test_the_sweep_goes_to_and_fro(ros_domain: int) -> None:
    distances = heard_from_sonar(ros_domain, 150, pattern="sweep", sweep_period=0.5)
    assert min(distances) == pytest.approx(0.2, abs=0.05)
    assert max(distances) == pytest.approx(3.0, abs=0.05)
    steps = [abs(b - a) for a, b in itertools.pairwise(distances)]
    assert sorted(steps)[len(steps) // 2] < 0.2


@pytest.mark.parametrize(("value", "expected"), [(1.25, 1.25), (".inf", math.inf)])
def test_the_constant_sonar(ros_domain: int, value: object, expected: float) -> None:
    distances = heard_from_sonar(ros_domain, 5, pattern="constant", value=value)
    assert set(distances) == {expected}


def test_dropouts_are_readings_that_are_no_number(ros_domain: int) -> None:
    distances = heard_from_sonar(ros_domain, 100, dropout=0.5)
    assert 10 < sum(map(math.isnan, distances)) < len(distances) - 10

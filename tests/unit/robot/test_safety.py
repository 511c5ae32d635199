"""The rules by which the robot stops: what a distance means, what passes the gate, who drives."""

from __future__ import annotations

import math

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from robot.safety.distance import (
    RangeState,
    Reading,
    SafetyZone,
    Shares,
    Verdict,
    allowed,
    gate,
    range_state,
    share,
    where,
)
from robot.safety.several import LowestReading, SlowestCommand, Streams
from robot.safety.sources import HELD_AGE_S, Sources
from robot.words import STOP, DriveSetpoint

any_float = st.floats(allow_nan=True, allow_infinity=True)
parts = st.floats(0, 1)
distances = any_float | st.floats(0, 3)
ages = any_float | st.floats(0, 3)
readings = st.builds(Reading, st.none() | distances, ages)
zones = st.builds(SafetyZone, st.floats(0.01, 100) | st.just(0.5), st.floats(0, 100), st.floats(0.05, 60))
setpoints = st.builds(DriveSetpoint, any_float, any_float)


@pytest.mark.parametrize(
    ("distance", "state"),
    [
        (0.5, RangeState.FREE), (0.499, RangeState.CLOSE), (0.0, RangeState.CLOSE),
        (math.inf, RangeState.FREE), (-math.inf, RangeState.CLOSE), (math.nan, RangeState.INVALID),
        (-1.0, RangeState.INVALID), (None, RangeState.SILENT),
    ],
)  # fmt: skip
def test_what_a_fresh_reading_means(distance: float | None, state: RangeState) -> None:
    assert range_state(Reading(distance, 0.1), critical_m=0.5, stale_after_s=1.0) == state


@pytest.mark.parametrize("age", [1.001, math.inf, math.nan])
def test_a_long_silence_is_danger_however_far_the_last_obstacle_was(age: float) -> None:
    assert range_state(Reading(3.0, age), critical_m=0.5, stale_after_s=1.0) == RangeState.SILENT


@given(st.sampled_from(RangeState), st.none() | st.sampled_from(RangeState))
def test_only_a_free_view_leaves_a_direction_open(front: RangeState, rear: RangeState | None) -> None:
    forward = gate(DriveSetpoint(0.3, 0.1), where(front, rear, emergency=False))
    backward = gate(DriveSetpoint(-0.3, 0.1), where(front, rear, emergency=False))
    assert (forward.speed_m_s > 0) == (front == RangeState.FREE)
    assert (backward.speed_m_s < 0) == (rear in (None, RangeState.FREE))


@given(setpoints, st.sampled_from(RangeState), st.none() | st.sampled_from(RangeState))
def test_nothing_moves_during_an_emergency_stop(
    command: DriveSetpoint, front: RangeState, rear: RangeState | None
) -> None:
    assert gate(command, where(front, rear, emergency=True)) == STOP


@given(setpoints, st.sampled_from(Verdict), st.builds(Shares, parts, parts))
def test_what_passes_is_a_number_and_no_faster_than_was_asked(
    command: DriveSetpoint, verdict: Verdict, shares: Shares
) -> None:
    passed = gate(command, verdict, shares)
    assert math.isfinite(passed.speed_m_s)
    assert passed.steering_rad in (0.0, command.steering_rad)
    if passed.speed_m_s:
        assert abs(passed.speed_m_s) <= abs(command.speed_m_s)
        assert math.copysign(1, passed.speed_m_s) == math.copysign(1, command.speed_m_s)
    if verdict == Verdict.STARTING:
        assert passed == STOP
    if math.isfinite(command.speed_m_s) and not allowed(command.speed_m_s, verdict, shares):
        assert passed.speed_m_s == 0


def test_a_blocked_robot_may_still_turn_its_wheels_and_back_off() -> None:
    verdict = where(RangeState.CLOSE, None, emergency=False)
    assert gate(DriveSetpoint(0.5, 0.4), verdict) == DriveSetpoint(0.0, 0.4)
    assert gate(DriveSetpoint(-0.3, 0.4), verdict) == DriveSetpoint(-0.3, 0.4)


# ---------------------------------------------------------------- slowing down

ZONE = SafetyZone(critical_m=0.5, slow_m=1.0, stale_after_s=1.0)


@pytest.mark.parametrize(
    ("distance", "part"),
    [
        (math.inf, 1.0), (1.0, 1.0), (0.75, 0.5), (0.6, 0.2), (0.5, 0.0), (0.2, 0.0),
        (-math.inf, 0.0), (math.nan, 0.0), (-1.0, 0.0), (None, 0.0),
    ],
)  # fmt: skip
def test_speed_is_slowed_in_proportion(distance: float | None, part: float) -> None:
    assert share(Reading(distance, 0.1), ZONE) == pytest.approx(part)
    assert share(Reading(distance, 1.1), ZONE) == 0.0, "a reading that is too old"


@given(readings, zones)
def test_a_share_is_a_share_and_nothing_where_the_way_is_not_free(reading: Reading, zone: SafetyZone) -> None:
    part = share(reading, zone)
    assert 0.0 <= part <= 1.0
    if range_state(reading, zone.critical_m, zone.stale_after_s) != RangeState.FREE:
        assert part == 0.0


@given(distances, distances, zones)
def test_nearer_is_never_faster(one: float, other: float, zone: SafetyZone) -> None:
    if math.isnan(one) or math.isnan(other):
        return
    near, far = sorted((one, other))
    assert share(Reading(near), zone) <= share(Reading(far), zone)


@given(zones)
def test_it_stands_at_the_critical_distance_and_is_free_from_the_slow_one_on(zone: SafetyZone) -> None:
    slows = zone.slow_m > zone.critical_m
    assert share(Reading(zone.critical_m), zone) == (0.0 if slows else 1.0)
    assert share(Reading(max(zone.critical_m, zone.slow_m)), zone) == 1.0


@given(distances, st.floats(0, 0.5))
def test_a_slow_distance_within_the_critical_one_slows_nothing(distance: float, slow_m: float) -> None:
    zone = SafetyZone(critical_m=0.5, slow_m=slow_m)
    assert share(Reading(distance), zone) in (0.0, 1.0)


@given(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), parts, parts)
def test_each_way_is_slowed_by_its_own_sensor(speed: float, steering: float, forward: float, backward: float) -> None:
    passed = gate(DriveSetpoint(speed, steering), Verdict.FREE, Shares(forward, backward))
    assert passed.speed_m_s == pytest.approx(speed * (backward if speed < 0 else forward))
    assert passed.steering_rad == steering


KEYS, ACTION, WORDS = "/drive_teleop", "/drive_action", "/drive"
RANKED = (KEYS, ACTION, WORDS)
FAST, SLOW = DriveSetpoint(0.5, 0.0), DriveSetpoint(0.1, 0.0)


def driver(sources: Sources, now_s: float) -> str:
    order = sources.driving(now_s)
    return order.source if order else ""


def test_the_first_in_rank_drives_as_long_as_its_command_is_young() -> None:
    sources = Sources(RANKED, max_age_s=0.5)
    assert driver(sources, 0.0) == ""
    assert sources.hear(WORDS, FAST, 0.0).source == WORDS
    assert sources.hear(KEYS, SLOW, 0.1).source == KEYS
    assert sources.hear(WORDS, FAST, 0.2).source == KEYS, "ignored"
    assert sources.hear(ACTION, FAST, 0.3).source == KEYS, "ignored"
    assert driver(sources, 0.599) == KEYS
    assert driver(sources, 0.601) == ACTION, "its own command is younger than that"
    assert driver(sources, 0.801) == ""


def test_what_was_said_long_ago_does_not_revive() -> None:
    sources = Sources(RANKED, max_age_s=0.5)
    sources.hear(WORDS, FAST, 0.0)
    for step in range(10):
        sources.hear(KEYS, SLOW, 0.1 * step)
    assert driver(sources, 1.3) == KEYS
    assert driver(sources, 1.5) == ""


@pytest.mark.parametrize("longer_s", [10.0, 0.0])
def test_a_longer_age_revives_nothing_that_was_too_old(longer_s: float) -> None:
    sources = Sources(RANKED, max_age_s=0.5)
    sources.hear(ACTION, FAST, 0.0)
    sources.hear(WORDS, FAST, 0.2)
    sources.let_age(longer_s, 0.6)
    assert driver(sources, 0.6) == WORDS, "it was young enough"
    sources.let_age(0.5, 0.6)
    assert driver(sources, 0.8) == ""
    sources.let_age(longer_s, 0.8)
    assert driver(sources, 0.8) == ""


def test_a_person_who_asks_for_a_stop_is_obeyed_too() -> None:
    sources = Sources(RANKED, max_age_s=0.5)
    sources.hear(WORDS, FAST, 0.0)
    assert sources.hear(KEYS, STOP, 0.1).setpoint == STOP
    assert driver(sources, 0.4) == KEYS


def test_a_corrected_order_keeps_its_age() -> None:
    sources = Sources(RANKED, max_age_s=0.5)
    order = sources.hear(WORDS, FAST, 0.0)
    sources.correct(order, STOP)
    kept = sources.driving(0.4)
    assert kept is not None
    assert kept.setpoint == STOP
    assert kept.age_s(0.4) == pytest.approx(0.4)
    assert sources.driving(0.6) is None
    sources.hear(WORDS, SLOW, 0.7)
    sources.correct(order, STOP)
    newest = sources.driving(0.7)
    assert newest is not None
    assert newest.setpoint == SLOW, "a newer one is not corrected for the old one's sake"


def test_after_forgetting_everybody_has_to_ask_anew() -> None:
    sources = Sources(RANKED, max_age_s=0.5)
    sources.hear(WORDS, FAST, 0.0)
    sources.hear(KEYS, FAST, 0.0)
    sources.forget()
    assert driver(sources, 0.0) == ""


def test_without_an_age_a_source_holds_until_it_asks_for_a_stop() -> None:
    sources = Sources(RANKED, max_age_s=0.0)
    sources.hear(KEYS, SLOW, 0.0)
    assert sources.hear(WORDS, FAST, 100.0).source == KEYS
    assert sources.hear(KEYS, STOP, 200.0).source == KEYS
    order = sources.driving(300.0)
    assert order is not None
    assert order.setpoint == STOP, "what the ignored one said before does not revive"
    assert sources.hear(WORDS, FAST, 400.0).source == WORDS
    assert driver(sources, 1e9) == WORDS


heard = st.lists(
    st.tuples(
        st.sampled_from(RANKED),
        st.builds(DriveSetpoint, st.sampled_from([-0.3, 0.0, 0.3]), st.just(0.1)),
        st.floats(0, 1),
    ),
    max_size=20,
)


@given(heard, st.sampled_from([0.1, 0.5, 2.0]), st.floats(0, 3))
def test_whoever_drives_is_the_first_whose_newest_command_is_young_enough(
    said: list[tuple[str, DriveSetpoint, float]], max_age_s: float, after_s: float
) -> None:
    sources, now_s = Sources(RANKED, max_age_s), 0.0
    newest: dict[str, tuple[DriveSetpoint, float]] = {}
    for source, setpoint, later_s in said:
        now_s += later_s
        newest[source] = (setpoint, now_s)
        driving = sources.hear(source, setpoint, now_s)
        assert RANKED.index(driving.source) <= RANKED.index(source)
    now_s += after_s
    young = [name for name in RANKED if name in newest and now_s - newest[name][1] < max_age_s]
    order = sources.driving(now_s)
    if not young:
        assert order is None
    else:
        assert order is not None
        assert (order.source, order.setpoint) == (young[0], newest[young[0]][0])


@given(heard)
@example([(KEYS, SLOW, 0.0), (ACTION, FAST, 0.0), (KEYS, STOP, 0.0), (WORDS, SLOW, 0.0)])
def test_without_an_age_an_ignored_command_never_drives(said: list[tuple[str, DriveSetpoint, float]]) -> None:
    sources, now_s, ignored = Sources(RANKED, 0.0), 0.0, set()
    for number, (source, setpoint, _) in enumerate(said):
        now_s = float(number)
        if sources.hear(source, setpoint, now_s).heard_s != now_s:
            ignored.add(now_s)
        order = sources.driving(now_s)
        assert order is not None
        assert order.heard_s not in ignored


def test_a_person_who_is_gone_holds_nothing_even_where_nothing_grows_old() -> None:
    sources = Sources(RANKED, 0.0, {KEYS})
    sources.hear(WORDS, FAST, 0.0)
    assert sources.hear(KEYS, SLOW, 100.0).source == KEYS
    assert driver(sources, 100.0 + HELD_AGE_S - 0.01) == KEYS
    assert driver(sources, 100.0 + HELD_AGE_S) == "", "nor does what was said before revive"
    assert sources.hear(WORDS, FAST, 101.0).source == WORDS
    assert driver(sources, 1e6) == WORDS
    assert Sources(RANKED, 9.0, {KEYS}).limit_s(KEYS) == HELD_AGE_S
    assert Sources(RANKED, 0.1, {KEYS}).limit_s(KEYS) == 0.1


STALE_S = 0.5


def played(*streams: tuple[float, float, float], until_s: float = 3.0) -> LowestReading:
    """Publishers, each with its period, its distance and when it stops, that speak in turn."""
    seen = LowestReading(0.0)
    said = sorted(
        (count * period_s + index * 0.001, count + 1 + 1000 * index, metres)
        for index, (period_s, metres, end_s) in enumerate(streams)
        for count in range(int(min(end_s, until_s) / period_s) + 1)
    )
    for now_s, number, metres in said:
        seen.see(metres, now_s, number=number, publishers=len(streams))
    return seen


def state_of(seen: LowestReading, now_s: float = 3.0) -> RangeState:
    return range_state(seen.reading(now_s, STALE_S), 0.3, STALE_S)


@pytest.mark.parametrize("fake_period_s", [0.01, 0.05, 0.1, 0.4])
@pytest.mark.parametrize("fake_m", [9.0, math.inf])
def test_the_lowest_counts_whoever_speaks_more_often(fake_period_s: float, fake_m: float) -> None:
    assert state_of(played((0.1, 0.2, 9), (fake_period_s, fake_m, 9))) == RangeState.CLOSE
    assert state_of(played((0.1, 2.0, 9), (fake_period_s, fake_m, 9))) == RangeState.FREE


def test_alone_the_newest_counts() -> None:
    seen = LowestReading(0.0)
    for number, metres in enumerate((0.2, 1.0), 1):
        seen.see(metres, number * 0.01, number=number)
    reading = seen.reading(0.03, STALE_S)
    assert reading.distance_m == 1.0
    assert reading.age_s == pytest.approx(0.01)


def test_a_sensor_without_a_valid_reading_is_not_covered_up() -> None:
    assert state_of(played((0.1, math.nan, 9), (0.05, 9.0, 9))) == RangeState.INVALID


def test_a_single_reading_that_is_lost_is_forgotten_with_the_next() -> None:
    seen = LowestReading(0.0)
    for number in range(1, 40):
        now_s = number * 0.1
        seen.see(math.nan if number == 20 else 2.0, now_s, number=number, publishers=2)
        seen.see(9.0, now_s + 0.01, number=500 + number, publishers=2)
        expected = RangeState.INVALID if number == 20 else RangeState.FREE
        assert state_of(seen, now_s + 0.02) == expected


def test_a_sensor_that_falls_silent_is_not_covered_up() -> None:
    assert state_of(played((0.1, 2.0, 1.5), (0.05, 9.0, 9))) == RangeState.SILENT


def test_a_driver_that_was_started_again_is_no_second_one() -> None:
    """The endpoint of the one that was killed stays in the graph for a while."""
    seen = LowestReading(0.0)
    for number in range(1, 11):
        seen.see(2.0, number * 0.1, number=100 + number)
    for number in range(1, 11):
        seen.see(2.0, 2.0 + number * 0.1, number=number, publishers=2)
    assert state_of(seen, 3.05) == RangeState.FREE


def test_when_the_second_has_left_the_newest_counts_again() -> None:
    seen = played((0.1, 2.0, 9), (0.05, 0.1, 9))
    assert state_of(seen) == RangeState.CLOSE
    seen.see(2.0, 3.01, number=31, publishers=1)
    assert state_of(seen, 3.02) == RangeState.FREE


@given(st.lists(st.tuples(st.integers(1, 5), st.floats(), st.booleans()), min_size=1, max_size=60))
def test_another_publisher_never_makes_it_bolder(said: list[tuple[int, float, bool]]) -> None:
    """Whatever else is said, what the one sensor has said last is no less dangerous with it."""
    alone, together = LowestReading(0.0), LowestReading(0.0)
    now_s, numbers = 0.0, [0, 1000]
    for ticks, metres, is_other in said:
        now_s += ticks * 0.01
        numbers[is_other] += 1
        together.see(metres, now_s, number=numbers[is_other], publishers=2)
        if not is_other:
            alone.see(metres, now_s, number=numbers[0])
        if state_of(alone, now_s) != RangeState.FREE and numbers[0]:
            assert state_of(together, now_s) != RangeState.FREE


def chosen(*said: tuple[float, float, bool], publishers: int = 2) -> float | None:
    """What counts after these commands: when, how fast, and whether by the other one."""
    slowest: SlowestCommand[float] = SlowestCommand()
    numbers, last = [0, 1000], None
    for now_s, speed, is_other in said:
        numbers[is_other] += 1
        last = slowest.choose(speed, speed, now_s, within_s=0.5, number=numbers[is_other], publishers=publishers)
    return last


def test_of_several_commands_the_slowest_counts_and_of_opposite_ones_none() -> None:
    assert chosen((0.0, 0.0, False), (0.1, 0.5, True)) == 0.0
    assert chosen((0.0, 0.2, False), (0.1, 0.5, True)) == 0.2
    assert chosen((0.0, -0.2, False), (0.1, -0.1, True)) == -0.1
    assert chosen((0.0, 0.2, False), (0.1, -0.1, True)) is None
    # One that falls silent is not replaced by the other.
    gate = [(0.1 * count, 0.5, False) for count in range(5)]
    foreign = [(0.1 * count + 0.05, 0.5, True) for count in range(15)]
    assert chosen(*sorted(gate + foreign)) is None
    assert chosen((0.0, 0.0, False), (0.1, 0.5, False), publishers=1) == 0.5


def test_streams_keep_apart_by_number() -> None:
    streams: Streams[str] = Streams()
    for number in range(1, 5):
        streams.hear("a", number, number * 0.1)
        streams.hear("b", number + 50, number * 0.1)
    assert sorted(streams.fresh(0.5, 1.0)) == ["a", "b"]
    streams.forget_but_newest()
    assert len(streams.fresh(0.5, 1.0)) == 1


MOCK, REAL = b"mock", b"real"


def two(*, at_once: bool, until_s: float) -> LowestReading:
    """A real sonar at 10 Hz, and a forgotten mock at 0.7 Hz: a second later, or from the start."""
    seen = LowestReading(0.0)
    beside_s = 0.0 if at_once else 2.0
    for tick in range(round(until_s * 10) + 1):
        now_s = tick * 0.1
        here = {REAL: "/sonar_front", MOCK: "/mock"} if now_s >= beside_s else {REAL: "/sonar_front"}
        if tick % 10 == 0:
            seen.are(here, now_s)
        seen.see(0.8, now_s, number=1000 + tick, publishers=len(here))
        if now_s >= beside_s and tick % 14 == 0:
            seen.see(9.0, now_s + 0.01, number=1 + tick // 14, publishers=len(here))
    return seen


def test_who_speaks_too_rarely_is_named_if_it_came_beside_the_other() -> None:
    seen = two(at_once=False, until_s=5.0)
    assert state_of(seen, 5.0) == RangeState.SILENT
    assert seen.too_rare(5.0, STALE_S) == ("/mock",)


def test_of_two_that_were_there_from_the_start_it_is_one() -> None:
    seen = two(at_once=True, until_s=5.0)
    assert state_of(seen, 5.0) == RangeState.SILENT
    assert seen.too_rare(5.0, STALE_S) == ("/mock", "/sonar_front")


def test_if_the_real_one_falls_silent_beside_a_mock_it_is_named_not_the_mock() -> None:
    seen = two(at_once=False, until_s=4.2)
    for count in range(1, 20):
        seen.see(9.0, 4.2 + count * 0.1, number=4 + count, publishers=2)
    assert state_of(seen, 6.1) == RangeState.SILENT
    assert seen.too_rare(6.1, STALE_S) == ("/sonar_front",)


def test_while_all_speak_or_none_does_nobody_is_too_rare() -> None:
    seen = two(at_once=False, until_s=4.2)
    assert seen.too_rare(4.25, STALE_S) == ()
    assert seen.too_rare(9.0, STALE_S) == ()

"""The rules by which the robot stops: what a distance means, and what passes the gate."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
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
from robot.words import STOP, DriveSetpoint

any_float = st.floats(allow_nan=True, allow_infinity=True)
parts = st.floats(0, 1)
distances = any_float | st.floats(0, 3)
ages = any_float | st.floats(0, 3)
readings = st.builds(Reading, st.none() | distances, ages)
zones = st.builds(
    SafetyZone, st.floats(0.01, 100) | st.just(0.5), st.floats(0, 100), st.floats(0.05, 60)
)
setpoints = st.builds(DriveSetpoint, any_float, any_float)


@pytest.mark.parametrize(
    ("distance", "state"),
    [
        (0.5, RangeState.FREE),
        (0.499, RangeState.CLOSE),
        (0.0, RangeState.CLOSE),
        (math.inf, RangeState.FREE),
        (-math.inf, RangeState.CLOSE),
        (math.nan, RangeState.INVALID),
        (-1.0, RangeState.INVALID),
        (None, RangeState.SILENT),
    ],
)
def test_what_a_fresh_reading_means(distance: float | None, state: RangeState) -> None:
    assert range_state(Reading(distance, 0.1), critical_m=0.5, stale_after_s=1.0) == state


@pytest.mark.parametrize("age", [1.001, math.inf, math.nan])
def test_a_long_silence_is_danger_however_far_the_last_obstacle_was(age: float) -> None:
    assert range_state(Reading(3.0, age), critical_m=0.5, stale_after_s=1.0) == RangeState.SILENT


@given(st.sampled_from(RangeState), st.none() | st.sampled_from(RangeState))
def test_only_a_free_view_leaves_a_direction_open(
    front: RangeState, rear: RangeState | None
) -> None:
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
        (math.inf, 1.0),
        (1.0, 1.0),
        (0.75, 0.5),
        (0.6, 0.2),
        (0.5, 0.0),
        (0.2, 0.0),
        (-math.inf, 0.0),
        (math.nan, 0.0),
        (-1.0, 0.0),
        (None, 0.0),
    ],
)
def test_speed_is_slowed_in_proportion(distance: float | None, part: float) -> None:
    assert share(Reading(distance, 0.1), ZONE) == pytest.approx(part)
    assert share(Reading(distance, 1.1), ZONE) == 0.0, "a reading that is too old"


@given(readings, zones)
def test_a_share_is_a_share_and_nothing_where_the_way_is_not_free(
    reading: Reading, zone: SafetyZone
) -> None:
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
def test_it_stands_at_the_critical_distance_and_is_free_from_the_slow_one_on(
    zone: SafetyZone,
) -> None:
    slows = zone.slow_m > zone.critical_m
    assert share(Reading(zone.critical_m), zone) == (0.0 if slows else 1.0)
    assert share(Reading(max(zone.critical_m, zone.slow_m)), zone) == 1.0


@given(distances, st.floats(0, 0.5))
def test_a_slow_distance_within_the_critical_one_slows_nothing(
    distance: float, slow_m: float
) -> None:
    zone = SafetyZone(critical_m=0.5, slow_m=slow_m)
    assert share(Reading(distance), zone) in (0.0, 1.0)


@given(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), parts, parts)
def test_each_way_is_slowed_by_its_own_sensor(
    speed: float, steering: float, forward: float, backward: float
) -> None:
    passed = gate(DriveSetpoint(speed, steering), Verdict.FREE, Shares(forward, backward))
    assert passed.speed_m_s == pytest.approx(speed * (backward if speed < 0 else forward))
    assert passed.steering_rad == steering

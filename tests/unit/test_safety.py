"""The rules by which the robot stops: what a distance means, and what passes the gate."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.safety import Reading, Sight, Verdict, gate, look, where
from robot.words import STOP, DriveSetpoint

any_float = st.floats(allow_nan=True, allow_infinity=True)
setpoints = st.builds(DriveSetpoint, any_float, any_float)


@pytest.mark.parametrize(
    ("distance", "sight"),
    [
        (0.5, Sight.FREE),
        (0.499, Sight.CLOSE),
        (0.0, Sight.CLOSE),
        (math.inf, Sight.FREE),
        (-math.inf, Sight.CLOSE),
        (math.nan, Sight.INVALID),
        (-1.0, Sight.INVALID),
        (None, Sight.SILENT),
    ],
)
def test_what_a_fresh_reading_means(distance: float | None, sight: Sight) -> None:
    assert look(Reading(distance, 0.1), critical_m=0.5, stale_after_s=1.0) == sight


@pytest.mark.parametrize("age", [1.001, math.inf, math.nan])
def test_a_long_silence_is_danger_however_far_the_last_obstacle_was(age: float) -> None:
    assert look(Reading(3.0, age), critical_m=0.5, stale_after_s=1.0) == Sight.SILENT


@given(st.sampled_from(Sight), st.none() | st.sampled_from(Sight))
def test_only_a_free_view_leaves_a_direction_open(front: Sight, rear: Sight | None) -> None:
    forward = gate(DriveSetpoint(0.3, 0.1), where(front, rear, emergency=False))
    backward = gate(DriveSetpoint(-0.3, 0.1), where(front, rear, emergency=False))
    assert (forward.speed_m_s > 0) == (front == Sight.FREE)
    assert (backward.speed_m_s < 0) == (rear in (None, Sight.FREE))


@given(setpoints, st.sampled_from(Sight), st.none() | st.sampled_from(Sight))
def test_nothing_moves_during_an_emergency_stop(
    command: DriveSetpoint, front: Sight, rear: Sight | None
) -> None:
    assert gate(command, where(front, rear, emergency=True)) == STOP


@given(setpoints, st.sampled_from(Verdict))
def test_what_passes_is_a_number_and_no_faster_than_was_asked(
    command: DriveSetpoint, verdict: Verdict
) -> None:
    passed = gate(command, verdict)
    assert math.isfinite(passed.speed_m_s)
    assert math.isfinite(passed.steering_rad)
    assert passed.speed_m_s in (0.0, command.speed_m_s)


def test_a_blocked_robot_may_still_turn_its_wheels_and_back_off() -> None:
    verdict = where(Sight.CLOSE, None, emergency=False)
    assert gate(DriveSetpoint(0.5, 0.4), verdict) == DriveSetpoint(0.0, 0.4)
    assert gate(DriveSetpoint(-0.3, 0.4), verdict) == DriveSetpoint(-0.3, 0.4)

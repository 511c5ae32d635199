"""The electronic differential: the numbers of the course, and what holds for every curve."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.kinematics import STRAIGHT_BELOW_RAD, turning_radius, wheel_speeds

speeds = st.floats(-5.0, 5.0)
angles = st.floats(-1.5, 1.5)
measures = st.floats(0.01, 5.0)


def test_the_course_s_left_turn() -> None:
    wheels = wheel_speeds(0.3, 0.5)
    assert wheels.radius_m == pytest.approx(0.4576, abs=5e-5)
    assert wheels.left_m_s == pytest.approx(0.2508, abs=5e-5)
    assert wheels.right_m_s == pytest.approx(0.3492, abs=5e-5)


def test_the_tightest_turn_of_the_mini_chassis() -> None:
    wheels = wheel_speeds(1.0, 0.3903, wheelbase_m=0.144, track_m=0.162)
    assert wheels.radius_m == pytest.approx(0.35, abs=5e-5)
    assert wheels.left_m_s == pytest.approx(0.7686, abs=5e-5)
    assert wheels.right_m_s == pytest.approx(1.2314, abs=5e-5)


@pytest.mark.parametrize("steering", [0.0, -0.0, 0.0099, -0.0099])
def test_below_a_hundredth_of_a_radian_is_straight(steering: float) -> None:
    wheels = wheel_speeds(0.5, steering)
    assert (wheels.left_m_s, wheels.right_m_s) == (0.5, 0.5)
    assert wheels.radius_m == math.inf


def test_from_a_hundredth_of_a_radian_on_it_is_a_curve() -> None:
    assert wheel_speeds(0.5, STRAIGHT_BELOW_RAD).radius_m < math.inf


@given(speeds, angles, measures, measures)
def test_the_wheels_mean_is_the_speed_of_the_axle(
    speed: float, steering: float, wheelbase: float, track: float
) -> None:
    wheels = wheel_speeds(speed, steering, wheelbase, track)
    scale = abs(wheels.left_m_s) + abs(wheels.right_m_s)
    mean = (wheels.left_m_s + wheels.right_m_s) / 2
    assert mean == pytest.approx(speed, abs=1e-9 * scale + 1e-12)


@given(speeds, angles)
def test_a_right_turn_mirrors_a_left_turn(speed: float, steering: float) -> None:
    left, right = wheel_speeds(speed, steering), wheel_speeds(speed, -steering)
    assert left.left_m_s == pytest.approx(right.right_m_s)
    assert left.right_m_s == pytest.approx(right.left_m_s)
    assert left.radius_m in (math.inf, pytest.approx(-right.radius_m))


@given(st.floats(0.01, 5.0), st.floats(STRAIGHT_BELOW_RAD, 1.5))
def test_the_inner_wheel_is_slower(speed: float, steering: float) -> None:
    assert wheel_speeds(speed, steering).left_m_s < wheel_speeds(speed, steering).right_m_s
    assert wheel_speeds(speed, -steering).left_m_s > wheel_speeds(speed, -steering).right_m_s


@given(speeds, angles)
def test_each_rim_follows_its_own_circle(speed: float, steering: float) -> None:
    """Both wheels and the axle turn about one centre, at one angular speed."""
    wheels = wheel_speeds(speed, steering, track_m=0.15)
    if wheels.radius_m != math.inf:
        turn_rad_s = speed / wheels.radius_m
        assert wheels.left_m_s == pytest.approx(turn_rad_s * (wheels.radius_m - 0.075), abs=1e-9)
        assert wheels.right_m_s == pytest.approx(turn_rad_s * (wheels.radius_m + 0.075), abs=1e-9)


@pytest.mark.parametrize("steering", [math.pi / 2, -2.0, math.nan, math.inf])
def test_an_angle_that_no_wheel_can_take_is_refused(steering: float) -> None:
    with pytest.raises(ValueError, match="right angle"):
        wheel_speeds(0.1, steering)


@pytest.mark.parametrize("speed", [math.nan, math.inf, -math.inf])
def test_a_speed_that_is_no_number_is_refused(speed: float) -> None:
    with pytest.raises(ValueError, match="finite"):
        wheel_speeds(speed, 0.1)


@pytest.mark.parametrize("measure", [0.0, -0.1, math.nan, math.inf])
def test_a_chassis_of_no_size_is_refused(measure: float) -> None:
    with pytest.raises(ValueError, match="wheelbase"):
        turning_radius(0.1, measure)
    with pytest.raises(ValueError, match="track"):
        wheel_speeds(0.1, 0.1, track_m=measure)

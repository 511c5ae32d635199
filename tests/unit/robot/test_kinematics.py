"""The electronic differential: the course's numbers, what holds for every curve, and limits."""

from __future__ import annotations

import importlib.util
import math
import struct
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.kinematics import STRAIGHT_BELOW_RAD, WHEEL_RADIUS_M, turning_radius, wheel_speeds
from robot.limits import PICO_RAD_S, RIM_M_S, SPEED, STEERING, Limits, first_excess, wheel_limits

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


CONFIG = Path(__file__).parents[3] / "firmware/pico2/config.py"
speeds_limits = st.floats(SPEED.low, SPEED.high)
angles_limits = st.floats(STEERING.low, STEERING.high)


@given(speeds_limits, angles_limits)
def test_no_curve_within_the_limits_asks_a_wheel_of_more_than_its_own(speed: float, steering: float) -> None:
    wheels = wheel_speeds(speed, steering)
    assert wheels.fastest_m_s <= RIM_M_S
    most = wheel_limits()
    assert most.allow(wheels.left_m_s / WHEEL_RADIUS_M)
    assert most.allow(wheels.right_m_s / WHEEL_RADIUS_M)


@given(st.floats(-1e30, 1e30), st.floats(-1.5, 1.5), st.floats(0.01, 5.0))
def test_wheels_that_are_slowed_stay_on_their_circle(speed: float, steering: float, most: float) -> None:
    asked = wheel_speeds(speed, steering)
    slowed = asked.slowed_to(most)
    assert slowed.fastest_m_s <= most * (1 + 1e-9)
    assert slowed.left_m_s * asked.right_m_s == pytest.approx(slowed.right_m_s * asked.left_m_s)
    assert slowed.fastest_m_s == pytest.approx(min(most, asked.fastest_m_s))


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 0.501, -0.8, 1e30, -1e308])
def test_what_is_beyond_is_named(value: float) -> None:
    assert not SPEED.allow(value)
    excess = first_excess((0.1, SPEED), (value, STEERING))
    assert excess is not None
    assert str(excess) == f"{value:g} rad, limit 0.5 rad"


@pytest.mark.parametrize("value", [0.1, 0.3, 0.5, -0.3, -0.5])
def test_the_32_bits_of_a_message_are_no_excess(value: float) -> None:
    (rounded,) = struct.unpack("f", struct.pack("f", value))
    assert Limits(-abs(value), abs(value), "").allow(rounded)
    assert first_excess((rounded, SPEED), (rounded, STEERING)) is None


def test_the_limits_here_are_those_of_the_firmware() -> None:
    spec = importlib.util.spec_from_file_location("pico_config", CONFIG)
    assert spec is not None
    assert spec.loader is not None
    config = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(config)
    assert round(PICO_RAD_S * 1000) == config.LIMIT_SPEED_MRAD_S
    assert wheel_limits().high < PICO_RAD_S < wheel_limits().high + 0.001
    assert config.MAX_SPEED_MRAD_S > config.LIMIT_SPEED_MRAD_S
    assert round(STEERING.high * 1000) == config.LIMIT_STEERING_MRAD

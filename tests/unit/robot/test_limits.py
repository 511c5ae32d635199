"""The limits of speed, steering and wheels, and what lies beyond them."""

from __future__ import annotations

import importlib.util
import math
import struct
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.kinematics import WHEEL_RADIUS_M, wheel_speeds
from robot.limits import (
    PICO_RAD_S,
    RIM_M_S,
    SPEED,
    STEERING,
    Limits,
    first_excess,
    wheel_limits,
)

CONFIG = Path(__file__).parents[3] / "firmware/pico2/config.py"
speeds = st.floats(SPEED.low, SPEED.high)
angles = st.floats(STEERING.low, STEERING.high)


@given(speeds, angles)
def test_no_curve_within_the_limits_asks_a_wheel_of_more_than_its_own(
    speed: float, steering: float
) -> None:
    wheels = wheel_speeds(speed, steering)
    assert wheels.fastest_m_s <= RIM_M_S
    most = wheel_limits()
    assert most.allow(wheels.left_m_s / WHEEL_RADIUS_M)
    assert most.allow(wheels.right_m_s / WHEEL_RADIUS_M)


@given(st.floats(-1e30, 1e30), st.floats(-1.5, 1.5), st.floats(0.01, 5.0))
def test_wheels_that_are_slowed_stay_on_their_circle(
    speed: float, steering: float, most: float
) -> None:
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

"""The joints of the head: angles to pulses within limits, and turns at a speed."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nodes.drivers.head_words import SERVO_SETTINGS, contradiction
from robot.limits import Limits
from robot.motion.head import HeadJoint, turn_ms
from robot.wire.lsc16 import PULSE, ServoMove, decode, encode
from text.i18n import translated

JOINTS = st.builds(
    HeadJoint,
    servo=st.integers(1, 16),
    limits=st.tuples(st.floats(-90, -1), st.floats(1, 90)).map(lambda ends: Limits(*ends, "deg")),
    trim_deg=st.floats(-40, 40),
    reversed=st.booleans(),
    turn_deg=st.floats(90, 360),
)


@pytest.mark.parametrize(
    ("joint", "angle", "pulse"),
    [
        (HeadJoint(1), 0, 1500),
        (HeadJoint(1), 90, 2500),
        (HeadJoint(1), -90, 500),
        (HeadJoint(1, reversed=True), 90, 500),
        (HeadJoint(1, trim_deg=9), 0, 1600),
        (HeadJoint(1, trim_deg=9), -90, 600),
        (HeadJoint(1, trim_deg=9, reversed=True), 90, 600),
        (HeadJoint(1, turn_deg=270), 90, 2167),
    ],
)
def test_angles_become_pulses(joint: HeadJoint, angle: float, pulse: int) -> None:
    assert joint.pulse_us(angle) == pulse


def test_a_trim_takes_from_the_end_that_it_turns_to() -> None:
    assert HeadJoint(1, trim_deg=10).reach == Limits(-90, 80, "deg")
    assert HeadJoint(1, trim_deg=10, reversed=True).reach == Limits(-80, 90, "deg")
    assert HeadJoint(1, turn_deg=90).reach == Limits(-45, 45, "deg")
    assert HeadJoint(1, Limits(-30, 60, "deg"), trim_deg=10).reach == Limits(-30, 60, "deg")
    with pytest.raises(ValueError, match="81"):
        HeadJoint(1, trim_deg=10).pulse_us(81)
    with pytest.raises(ValueError, match="nan"):
        HeadJoint(1).pulse_us(float("nan"))


@given(JOINTS, st.floats(-120, 120))
def test_whatever_is_within_reach_is_a_pulse_that_the_controller_takes(
    joint: HeadJoint, angle: float
) -> None:
    if angle not in joint.reach:
        with pytest.raises(ValueError, match="within"):
            joint.pulse_us(angle)
        return
    assert angle in joint.limits
    pulse = joint.pulse_us(angle)
    assert pulse in PULSE
    move = ServoMove(turn_ms(joint.way_deg(None, angle), 10), ((joint.servo, pulse),))
    assert decode(encode(move)) == move


def test_a_turn_takes_its_time_and_the_longest_one_from_who_knows_where() -> None:
    joint = HeadJoint(1)
    assert joint.way_deg(joint.pulse_us(-36), 54) == 90
    assert HeadJoint(1, trim_deg=9).way_deg(1500, 0) == 9
    assert joint.way_deg(None, 60) == 150
    assert joint.way_deg(None, -90) == 180
    assert turn_ms(90, 90) == 1000
    assert turn_ms(100, 300) == 334
    assert turn_ms(0, 90) == 20
    assert turn_ms(360, 1) == 30_000


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, None),
        ({"pan_servo": 2}, "pan_servo and tilt_servo are both"),
        ({"pan_min": 10.0, "pan_max": 5.0}, "between pan_min and pan_max"),
        ({"tilt_min": 40.0, "servo_turn": 90.0, "tilt_trim": 10.0}, "with tilt_trim"),
    ],
)
def test_joints_without_room_are_told(changes: dict[str, Any], words: str | None) -> None:
    values = {setting.name: setting.default for setting in SERVO_SETTINGS} | changes
    phrase = contradiction(values)
    assert (phrase is None) if words is None else (phrase is not None and words in phrase)
    if phrase is not None:
        assert translated(phrase, "ru").format(**values)

"""Rotations: the directions of REP-103."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.motion.geometry import Quaternion, quaternion_from_rpy

angles = st.floats(-math.pi, math.pi)


def test_no_rotation_is_the_identity() -> None:
    assert quaternion_from_rpy(0.0, 0.0, 0.0) == Quaternion(0.0, 0.0, 0.0, 1.0)


def test_yaw_turns_to_the_left_about_z() -> None:
    turn = quaternion_from_rpy(0.0, 0.0, math.pi / 2)
    assert (turn.x, turn.y) == (0.0, 0.0)
    assert turn.z == pytest.approx(math.sqrt(0.5))
    assert turn.w == pytest.approx(math.sqrt(0.5))


def test_yaw_is_applied_after_pitch() -> None:
    """A camera pitched down by 90 degrees, then turned left by 90 degrees, looks down."""
    turn = quaternion_from_rpy(0.0, math.pi / 2, math.pi / 2)
    forward_z = 2 * (turn.x * turn.z - turn.w * turn.y)
    forward_x = 1 - 2 * (turn.y**2 + turn.z**2)
    assert forward_z == pytest.approx(-1.0)
    assert forward_x == pytest.approx(0.0, abs=1e-12)


@given(angles, angles, angles)
def test_every_rotation_has_length_one(roll: float, pitch: float, yaw: float) -> None:
    turn = quaternion_from_rpy(roll, pitch, yaw)
    assert turn.x**2 + turn.y**2 + turn.z**2 + turn.w**2 == pytest.approx(1.0)

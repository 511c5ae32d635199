"""Transforms, against answers that are known."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from space.transform import Quaternion, Transform, Vector, product, quaternion_from_rpy, slerp

QUARTER = math.pi / 2
angles = st.floats(-math.pi, math.pi)
lengths = st.floats(-100.0, 100.0)
transforms = st.builds(
    Transform.from_rpy,
    st.tuples(lengths, lengths, lengths),
    st.tuples(angles, angles, angles),
)


@pytest.mark.parametrize(
    ("rpy", "ahead", "left", "up"),
    [
        ((QUARTER, 0.0, 0.0), (1, 0, 0), (0, 0, 1), (0, -1, 0)),
        ((0.0, QUARTER, 0.0), (0, 0, -1), (0, 1, 0), (1, 0, 0)),
        ((0.0, 0.0, QUARTER), (0, 1, 0), (-1, 0, 0), (0, 0, 1)),
        # First roll, then pitch: REP-103's fixed axes.
        ((QUARTER, QUARTER, 0.0), (0, 0, -1), (1, 0, 0), (0, -1, 0)),
    ],
)
def test_angles_turn_the_axes_as_rep_103_says(
    rpy: Vector, ahead: Vector, left: Vector, up: Vector
) -> None:
    turned = Transform.from_rpy((0.0, 0.0, 0.0), rpy)
    assert turned.point((1.0, 0.0, 0.0)) == pytest.approx(ahead, abs=1e-12)
    assert turned.point((0.0, 1.0, 0.0)) == pytest.approx(left, abs=1e-12)
    assert turned.point((0.0, 0.0, 1.0)) == pytest.approx(up, abs=1e-12)


@given(st.tuples(angles, st.floats(-1.57, 1.57), angles))
def test_angles_come_back(rpy: Vector) -> None:
    back = Transform.from_rpy((0.0, 0.0, 0.0), rpy).rpy_rad
    for angle, other in zip(rpy, back, strict=True):
        assert math.remainder(angle - other, math.tau) == pytest.approx(0.0, abs=1e-5)


@given(angles, angles, st.sampled_from([-1.0, 1.0]))
def test_straight_up_or_down_the_angles_make_the_same_rotation(
    roll: float, yaw: float, sign: float
) -> None:
    made = Transform.from_rpy((0.0, 0.0, 0.0), (roll, sign * QUARTER, yaw))
    again = Transform.from_rpy((0.0, 0.0, 0.0), made.rpy_rad)
    assert np.allclose(made.matrix(), again.matrix(), atol=1e-4)


@given(transforms, transforms, transforms)
def test_transforms_are_joined_as_their_matrices(a: Transform, b: Transform, c: Transform) -> None:
    assert np.allclose((a @ b @ c).matrix(), a.matrix() @ b.matrix() @ c.matrix(), atol=1e-6)


@given(transforms, st.tuples(lengths, lengths, lengths))
def test_there_and_back_again(made: Transform, point: Vector) -> None:
    assert made.inverse().point(made.point(point)) == pytest.approx(point, abs=1e-9)
    many = np.array([point, (0.0, 0.0, 0.0)])
    assert np.allclose(made.points(many)[0], made.point(point), atol=1e-9)
    assert np.allclose(made.points(many)[1], made.translation)


def test_points_keep_their_kind() -> None:
    assert Transform().points(np.zeros((5, 3), np.float32)).dtype == np.float32


@given(angles, st.floats(0.0, 1.0))
def test_between_two_headings_the_turn_is_steady(yaw: float, share: float) -> None:
    assume(abs(yaw) < 3.14)
    between = Transform().between(Transform.from_rpy((2.0, 0.0, 0.0), (0.0, 0.0, yaw)), share)
    assert between.rpy_rad[2] == pytest.approx(yaw * share, abs=1e-3)
    assert between.translation[0] == pytest.approx(2.0 * share)


def test_between_takes_the_shorter_way_round() -> None:
    one = quaternion_from_rpy(0.0, 0.0, math.radians(170))
    other = quaternion_from_rpy(0.0, 0.0, math.radians(-170))
    middle = Transform((0.0, 0.0, 0.0), slerp(one, other, 0.5))
    assert abs(middle.rpy_rad[2]) == pytest.approx(math.pi)


@given(st.tuples(angles, angles, angles))
def test_a_quaternion_and_its_negative_are_one_rotation(rpy: Vector) -> None:
    q = quaternion_from_rpy(*rpy)
    minus: Quaternion = (-q[0], -q[1], -q[2], -q[3])
    assert np.allclose(
        Transform((0, 0, 0), slerp(q, minus, 0.3)).matrix(), Transform((0, 0, 0), q).matrix()
    )
    assert product(q, (-q[0], -q[1], -q[2], q[3])) == pytest.approx((0, 0, 0, 1), abs=1e-12)


def test_a_quaternion_is_scaled_and_nonsense_is_refused() -> None:
    assert Transform.of((1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 5.0)).rotation == (0.0, 0.0, 0.0, 1.0)
    for rotation in [(0.0, 0.0, 0.0, 0.0), (math.nan, 0.0, 0.0, 1.0)]:
        with pytest.raises(ValueError, match=r"quaternion|finite"):
            Transform.of((0.0, 0.0, 0.0), rotation)
    with pytest.raises(ValueError, match="finite"):
        Transform.of((math.inf, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))

"""Transforms, and one at any time between two."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from space.buffer import NoTransformError, Stamped, TransformBuffer
from space.transform import Transform, Vector

QUARTER = math.pi / 2
angles = st.floats(-math.pi, math.pi)
lengths = st.floats(-100.0, 100.0)
transforms = st.builds(Transform.from_rpy, st.tuples(lengths, lengths, lengths), st.tuples(angles, angles, angles))


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
def test_angles_turn_the_axes_as_rep_103_says(rpy: Vector, ahead: Vector, left: Vector, up: Vector) -> None:
    turned = Transform.from_rpy((0.0, 0.0, 0.0), rpy)
    assert turned.point((1.0, 0.0, 0.0)) == pytest.approx(ahead, abs=1e-12)
    assert turned.point((0.0, 1.0, 0.0)) == pytest.approx(left, abs=1e-12)
    assert turned.point((0.0, 0.0, 1.0)) == pytest.approx(up, abs=1e-12)


@given(st.tuples(angles, st.floats(-1.57, 1.57), angles))
def test_angles_come_back(rpy: Vector) -> None:
    back = Transform.from_rpy((0.0, 0.0, 0.0), rpy).rpy_rad
    for angle, other in zip(rpy, back, strict=True):
        assert math.remainder(angle - other, math.tau) == pytest.approx(0.0, abs=1e-5)


@given(transforms, transforms, transforms)
def test_transforms_are_joined_as_their_matrices(a: Transform, b: Transform, c: Transform) -> None:
    assert np.allclose((a @ b @ c).matrix(), a.matrix() @ b.matrix() @ c.matrix(), atol=1e-6)


@given(transforms, st.tuples(lengths, lengths, lengths))
def test_there_and_back_again(made: Transform, point: Vector) -> None:
    assert made.inverse().point(made.point(point)) == pytest.approx(point, abs=1e-9)
    many = np.array([point, (0.0, 0.0, 0.0)])
    assert np.allclose(made.points(many)[0], made.point(point), atol=1e-9)
    assert np.allclose(made.points(many)[1], made.translation)


@given(angles, st.floats(0.0, 1.0))
def test_between_two_headings_the_turn_is_steady(yaw: float, share: float) -> None:
    assume(abs(yaw) < 3.14)
    between = Transform().between(Transform.from_rpy((2.0, 0.0, 0.0), (0.0, 0.0, yaw)), share)
    assert between.rpy_rad[2] == pytest.approx(yaw * share, abs=1e-3)
    assert between.translation[0] == pytest.approx(2.0 * share)


def test_a_quaternion_is_scaled_and_nonsense_is_refused() -> None:
    assert Transform.of((1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 5.0)).rotation == (0.0, 0.0, 0.0, 1.0)
    for rotation in [(0.0, 0.0, 0.0, 0.0), (math.nan, 0.0, 0.0, 1.0)]:
        with pytest.raises(ValueError, match=r"quaternion|finite"):
            Transform.of((0.0, 0.0, 0.0), rotation)
    with pytest.raises(ValueError, match="finite"):
        Transform.of((math.inf, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


def at(parent: str, child: str, stamp_s: float, place: Vector, yaw: float = 0.0, *, static: bool = False) -> Stamped:
    transform = Transform.from_rpy(place, (0.0, 0.0, yaw))
    return Stamped(parent, child, stamp_s, transform, static=static)


@pytest.fixture
def robot() -> TransformBuffer:
    """A robot at (2, 1) that looks to the left, with a camera 0.15 m ahead and 0.25 m up."""
    buffer = TransformBuffer()
    buffer.add(
        [
            at("odom", "base_link", 10.0, (2.0, 1.0, 0.0), QUARTER),
            at("base_link", "camera_link", 0.0, (0.15, 0.0, 0.25), static=True),
        ]
    )
    return buffer


def test_a_ball_ahead_of_the_camera_is_where_the_course_says(robot: TransformBuffer) -> None:
    # The guide's example: 1 m ahead of the camera is 1.15 m ahead of the wheels.
    assert robot.find("base_link", "camera_link").point((1.0, 0.0, 0.0)) == pytest.approx((1.15, 0.0, 0.25))
    assert robot.find("odom", "camera_link").point((1.0, 0.0, 0.0)) == pytest.approx((2.0, 2.15, 0.25))
    assert robot.find("camera_link", "odom").point((2.0, 2.15, 0.25)) == pytest.approx((1.0, 0.0, 0.0))


def test_between_two_times_it_interpolates(robot: TransformBuffer) -> None:
    robot.add([at("odom", "base_link", 11.0, (4.0, 1.0, 0.0), 0.0)])
    quarter = robot.find("odom", "base_link", 10.25)
    assert quarter.translation == pytest.approx((2.5, 1.0, 0.0))
    assert quarter.rpy_rad[2] == pytest.approx(QUARTER * 0.75)
    assert robot.find("odom", "base_link", 11.0).translation == pytest.approx((4.0, 1.0, 0.0))


@pytest.mark.parametrize("asked", [9.9, 11.1])
def test_beyond_what_is_known_it_refuses(robot: TransformBuffer, asked: float) -> None:
    robot.add([at("odom", "base_link", 11.0, (4.0, 1.0, 0.0))])
    with pytest.raises(NoTransformError, match=r"base_link.* 10\.000 s to 11\.000 s"):
        robot.find("odom", "camera_link", asked)


def test_messages_out_of_order_are_put_in_their_place(robot: TransformBuffer) -> None:
    robot.add([at("odom", "base_link", 12.0, (4.0, 1.0, 0.0), QUARTER)])
    robot.add([at("odom", "base_link", 11.0, (9.0, 1.0, 0.0), QUARTER)])
    assert robot.find("odom", "base_link").translation[0] == pytest.approx(4.0)
    assert robot.find("odom", "base_link", 10.5).translation[0] == pytest.approx(5.5)


def test_what_is_older_than_ten_seconds_is_forgotten(robot: TransformBuffer) -> None:
    robot.add([at("odom", "base_link", float(stamp), (0.0, 0.0, 0.0)) for stamp in range(11, 25)])
    with pytest.raises(NoTransformError, match=r"14\.000 s to 24\.000 s"):
        robot.find("odom", "base_link", 13.9)

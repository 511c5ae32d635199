"""The buffer of transforms, against answers that are known."""

from __future__ import annotations

import math
import re

import pytest

from space.buffer import NoTransformError, Stamped, TransformBuffer
from space.transform import Transform, Vector

QUARTER = math.pi / 2


def at(
    parent: str,
    child: str,
    stamp_s: float,
    place: Vector,
    yaw: float = 0.0,
    *,
    static: bool = False,
) -> Stamped:
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
    assert robot.find("base_link", "camera_link").point((1.0, 0.0, 0.0)) == pytest.approx(
        (1.15, 0.0, 0.25)
    )
    assert robot.find("odom", "camera_link").point((1.0, 0.0, 0.0)) == pytest.approx(
        (2.0, 2.15, 0.25)
    )
    assert robot.find("camera_link", "odom").point((2.0, 2.15, 0.25)) == pytest.approx(
        (1.0, 0.0, 0.0)
    )


def test_two_branches_meet_below_the_root(robot: TransformBuffer) -> None:
    robot.add([at("base_link", "sonar", 0.0, (0.2, 0.0, 0.1), static=True)])
    assert robot.find("sonar", "camera_link").translation == pytest.approx((-0.05, 0.0, 0.15))
    assert robot.frames == {"odom", "base_link", "camera_link", "sonar"}
    assert robot.way_up("sonar") == ["sonar", "base_link", "odom"]


def test_between_two_times_it_interpolates(robot: TransformBuffer) -> None:
    robot.add([at("odom", "base_link", 11.0, (4.0, 1.0, 0.0), 0.0)])
    quarter = robot.find("odom", "base_link", 10.25)
    assert quarter.translation == pytest.approx((2.5, 1.0, 0.0))
    assert quarter.rpy_rad[2] == pytest.approx(QUARTER * 0.75)
    assert robot.find("odom", "base_link", 11.0).translation == pytest.approx((4.0, 1.0, 0.0))


def test_the_newest_is_that_of_the_slowest_frame_on_the_way(robot: TransformBuffer) -> None:
    robot.add(
        [
            at("odom", "base_link", 11.0, (4.0, 1.0, 0.0), QUARTER),
            at("base_link", "arm", 10.5, (1.0, 0.0, 0.0)),
        ]
    )
    assert robot.find("odom", "arm").translation == pytest.approx((3.0, 2.0, 0.0))


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


def test_another_parent_begins_anew(robot: TransformBuffer) -> None:
    robot.add([at("map", "base_link", 11.0, (7.0, 0.0, 0.0))])
    assert robot.find("map", "camera_link").translation == pytest.approx((7.15, 0.0, 0.25))
    with pytest.raises(NoTransformError, match="no frame odom"):
        robot.find("odom", "base_link")


def test_two_trees_and_unknown_frames_have_their_own_words(robot: TransformBuffer) -> None:
    robot.add([at("map", "goal", 1.0, (0.0, 0.0, 0.0))])
    with pytest.raises(NoTransformError, match=re.escape("nothing joins odom and map")):
        robot.find("goal", "camera_link")
    with pytest.raises(NoTransformError, match="no frame moon"):
        robot.find("moon", "camera_link")


def test_a_loop_ends(robot: TransformBuffer) -> None:
    robot.add([at("camera_link", "odom", 10.0, (0.0, 0.0, 0.0))])
    assert set(robot.way_up("odom")) == {"odom", "camera_link", "base_link"}
    with pytest.raises(NoTransformError):
        robot.find("moon", "odom")
    robot.find("camera_link", "base_link")

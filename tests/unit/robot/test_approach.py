"""Driving to a point: it arrives from anywhere, and never asks for more than it may."""

from __future__ import annotations

import math

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from robot.limits import SPEED, STEERING
from robot.motion.approach import Approach, ApproachLimits, ApproachProgress
from robot.motion.odometry import Point, Pose, advance, yaw_from_quaternion
from robot.words import STOP, DriveSetpoint
from space.transform import quaternion_from_rpy

STEP_S = 0.05
angles = st.floats(-math.pi, math.pi)
places = st.floats(-20.0, 20.0)
poses = st.builds(Pose, places, places, angles)
chassis = st.builds(ApproachLimits, st.floats(0.05, SPEED.high), st.floats(0.15, STEERING.high), st.floats(0.1, 0.5))


def drive(start: Pose, approach: Approach, model: ApproachLimits) -> tuple[Pose, float]:
    """Simulate until it is there; the last pose and the metres driven. Fails if it is not."""
    pose, way_m, longest_m = start, 0.0, approach.longest_way_m(start)
    while not approach.reached(pose):
        command = approach.command(pose)
        assert abs(command.speed_m_s) <= model.max_speed_m_s
        assert abs(command.steering_rad) <= model.max_steering_rad
        assert command.speed_m_s != 0
        pose = advance(pose, command, STEP_S, model.wheelbase_m)
        way_m += abs(command.speed_m_s) * STEP_S
        assert way_m < longest_m, f"not there but at {pose}"
    return pose, way_m


@settings(deadline=None, max_examples=120)
@given(poses, angles, st.floats(0.0, 5.0), st.floats(0.03, 0.5), chassis)
@example(Pose(), math.pi / 2, 0.1, 0.03, ApproachLimits())
@example(Pose(), math.pi, 5.0, 0.03, ApproachLimits())
@example(Pose(), math.pi, 0.5, 0.03, ApproachLimits())
@example(Pose(), -math.pi / 2, 0.45, 0.03, ApproachLimits())
def test_it_arrives_from_anywhere_within_five_metres(
    start: Pose, bearing: float, distance: float, tolerance: float, model: ApproachLimits
) -> None:
    goal = Point(start.x_m + distance * math.cos(bearing), start.y_m + distance * math.sin(bearing))
    approach = Approach(goal, tolerance, model)
    end, _way = drive(start, approach, model)
    assert end.distance_to(goal) <= tolerance
    assert approach.command(end) == STOP


@given(poses, places, places, st.floats(0.02, 1.0), chassis)
def test_no_command_is_out_of_range(pose: Pose, x: float, y: float, tolerance: float, model: ApproachLimits) -> None:
    command = Approach(Point(x, y), tolerance, model).command(pose)
    assert command.speed_m_s in SPEED
    assert command.steering_rad in STEERING


def test_a_point_ahead_is_driven_to_straight_and_slower_near_it() -> None:
    approach = Approach(Point(2.0, 0.0), 0.05, ApproachLimits(max_speed_m_s=0.3))
    assert approach.command(Pose()) == DriveSetpoint(0.3, 0.0)
    near = approach.command(Pose(1.85, 0.0))
    assert near.steering_rad == 0.0
    assert 0 < near.speed_m_s < 0.3
    assert drive(Pose(), approach, ApproachLimits())[1] == pytest.approx(1.95, abs=0.02)


def test_a_point_close_behind_is_reversed_to_and_a_far_one_turned_to() -> None:
    assert Approach(Point(-0.8, 0.0), 0.05, ApproachLimits()).command(Pose()).speed_m_s < 0
    far = Approach(Point(-4.0, 0.0), 0.05, ApproachLimits()).command(Pose())
    assert far.speed_m_s > 0
    assert far.steering_rad == STEERING.high


def test_a_point_inside_the_turning_circle_is_backed_away_from() -> None:
    beside = Approach(Point(0.0, 0.3), 0.05, ApproachLimits())
    command = beside.command(Pose())
    assert command.speed_m_s < 0
    assert command.steering_rad == STEERING.low


@pytest.mark.parametrize("bad", [(0.0, 0.5), (0.6, 0.5), (0.3, 0.0), (0.3, 0.6), (math.nan, 0.5), (0.3, math.nan)])
def test_a_chassis_of_other_limits_than_the_commands_is_refused(bad: tuple[float, float]) -> None:
    with pytest.raises(ValueError, match="must be up to"):
        ApproachLimits(*bad)


# ---------------------------------------------------------------- giving up


def stands(progress: ApproachProgress, pose: Pose, now_s: float) -> bool:
    """Whether it stands, after one more pose."""
    progress.take(pose, now_s)
    return progress.stands


def test_a_robot_that_does_not_move_stands() -> None:
    progress = ApproachProgress(10.0, 3.0, Pose(), 0.0)
    assert not stands(progress, Pose(0.01, 0.0), 2.0)
    assert not stands(progress, Pose(0.01, 0.0), 3.0)
    assert stands(progress, Pose(0.01, 0.0), 3.1)


def test_a_robot_that_creeps_or_turns_does_not_stand() -> None:
    progress = ApproachProgress(10.0, 3.0, Pose(), 0.0)
    assert not stands(progress, Pose(0.05, 0.0), 2.9)
    assert not stands(progress, Pose(0.05, 0.0, 0.1), 5.8)
    assert stands(progress, Pose(0.05, 0.0, 0.1), 8.9)


def test_a_robot_that_drives_and_drives_has_driven_too_far() -> None:
    progress = ApproachProgress(1.0, 3.0, Pose(), 0.0)
    for second in range(1, 6):
        stands(progress, Pose(0.3 if second % 2 else 0.0), float(second))
        assert progress.has_driven_too_far == (second > 3)


# ---------------------------------------------------------------- the base


@given(poses, st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(0.0, 2.0))
def test_a_way_in_two_steps_is_the_way_in_one(pose: Pose, speed: float, steering: float, seconds: float) -> None:
    command = DriveSetpoint(speed, steering)
    halfway = advance(pose, command, seconds / 2)
    one, two = advance(pose, command, seconds), advance(halfway, command, seconds / 2)
    assert two.distance_to(one) < 1e-6
    assert math.cos(two.heading_rad - one.heading_rad) == pytest.approx(1.0)


def test_it_drives_where_it_looks() -> None:
    end = advance(Pose(1.0, 2.0, math.pi / 2), DriveSetpoint(0.5, 0.0), 2.0)
    assert (end.x_m, end.y_m) == pytest.approx((1.0, 3.0))
    assert advance(Pose(), DriveSetpoint(0.3, 0.4), 0.5).y_m > 0


@given(angles)
def test_a_heading_survives_the_quaternion(heading: float) -> None:
    back = yaw_from_quaternion(*quaternion_from_rpy(0.0, 0.0, heading))
    assert math.cos(back - heading) == pytest.approx(1.0)


def test_no_rotation_at_all_is_no_number() -> None:
    assert math.isnan(yaw_from_quaternion(0.0, 0.0, 0.0, 0.0))
    assert not Pose(0.0, 0.0, math.nan).is_finite

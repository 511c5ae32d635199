"""robot/description/robot.urdf has the sizes that the rest of the code has."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import pytest

from robot.joints import DRIVE_JOINTS, HEAD_JOINTS, HEAD_PAN, HEAD_TILT, STEERING
from robot.kinematics import TRACK_M, WHEEL_RADIUS_M, WHEELBASE_M
from robot.limits import HEAD_ANGLE, PICO_RAD_S
from robot.limits import STEERING as STEERING_LIMITS
from robot.motion.odometry import Pose
from robot.world.view import AHEAD_M, HEIGHT_M
from robot.world.world import Body
from space.robot_model import Cuboid, Cylinder, RobotModel, Solid
from space.transform import IDENTITY, Transform, Vector
from space.urdf import read_urdf

FILE = Path(__file__).parents[3] / "robot" / "description" / "robot.urdf"
BODY = Body()
WHEELS = ("rear_left_wheel", "rear_right_wheel", "front_left_wheel", "front_right_wheel")


@pytest.fixture(scope="module")
def model() -> RobotModel:
    return read_urdf(FILE.read_text())


def place(model: RobotModel, link: str, **positions: float) -> Transform:
    """Where a link is in base_link, each joint at its position, 0 where none is given."""
    held = {joint.child: joint for joint in model.joints.values()}
    where, known = IDENTITY, model.followed(positions)
    while link in held:
        joint = held[link]
        where = joint.transform(known.get(joint.name, 0.0)) @ where
        link = joint.parent
    assert link == model.root == "base_link"
    return where


def corners(shape: Solid) -> list[Vector]:
    """Points of a shape between which all of it lies."""
    if isinstance(shape, Cuboid):
        x, y, z = (size / 2 for size in shape.size_m)
    else:
        assert isinstance(shape, Cylinder)
        x, y, z = shape.radius_m, shape.radius_m, shape.length_m / 2
    return [(a * x, b * y, c * z) for a, b, c in itertools.product((-1, 1), repeat=3)]


def points_of(model: RobotModel, link: str) -> list[Vector]:
    return [
        (place(model, link) @ visual.origin).point(corner)
        for visual in model.links[link].visuals
        for corner in corners(visual.shape)
    ]


def test_every_joint_that_drivers_report_is_there_and_every_other_follows(
    model: RobotModel,
) -> None:
    movable = {name: joint for name, joint in model.joints.items() if joint.movable}
    reported = {name for name, joint in movable.items() if joint.mimic is None}
    assert reported == {*DRIVE_JOINTS, *HEAD_JOINTS}
    assert all(joint.movable or joint.type.value == "fixed" for joint in model.joints.values())


def test_the_wheels_are_where_the_kinematics_have_them(model: RobotModel) -> None:
    left, right = (place(model, link).translation for link in WHEELS[:2])
    assert left == pytest.approx((0.0, TRACK_M / 2, WHEEL_RADIUS_M))
    assert right == pytest.approx((0.0, -TRACK_M / 2, WHEEL_RADIUS_M))
    for link in WHEELS[2:]:
        assert place(model, link).translation[0] == pytest.approx(WHEELBASE_M)
    for link in WHEELS:
        tyre = model.links[link].visuals[0]
        assert isinstance(tyre.shape, Cylinder)
        assert tyre.shape.radius_m == WHEEL_RADIUS_M
        # Its axis is across the robot.
        assert tyre.origin.point((0.0, 0.0, 1.0)) == pytest.approx((0, -1, 0), abs=1e-6)


@pytest.mark.parametrize("link", WHEELS)
def test_forward_the_top_of_a_wheel_moves_ahead(model: RobotModel, link: str) -> None:
    turned = place(model, link, rear_left_wheel_joint=0.1, rear_right_wheel_joint=0.1)
    top = turned.point((0.0, 0.0, WHEEL_RADIUS_M))
    assert top[0] > place(model, link).point((0.0, 0.0, WHEEL_RADIUS_M))[0] + 0.003


def test_both_front_wheels_steer_to_the_left_by_a_positive_angle(model: RobotModel) -> None:
    for link in WHEELS[2:]:
        ahead = place(model, link, steering_joint=0.3)
        assert ahead.rpy_rad[2] == pytest.approx(0.3)
    steering = model.joints[STEERING]
    assert (steering.lower, steering.upper) == (STEERING_LIMITS.low, STEERING_LIMITS.high)
    assert model.joints[DRIVE_JOINTS[0]].velocity == PICO_RAD_S
    assert steering.velocity == BODY.steering_rad_s


def test_the_body_covers_the_floor_that_the_simulation_takes_for_it(model: RobotModel) -> None:
    points = [point for link in model.links for point in points_of(model, link)]
    outline = BODY.outline(Pose())
    assert min(x for x, _y, _z in points) == pytest.approx(outline.x_m - outline.length_m / 2)
    assert max(x for x, _y, _z in points) == pytest.approx(outline.x_m + outline.length_m / 2)
    assert min(y for _x, y, _z in points) == pytest.approx(-outline.width_m / 2)
    assert max(y for _x, y, _z in points) == pytest.approx(outline.width_m / 2)
    # It stands on the floor.
    assert min(z for _x, _y, z in points) == pytest.approx(0.0, abs=1e-6)


def test_the_camera_is_where_lesson_5_and_the_simulated_camera_have_it(model: RobotModel) -> None:
    straight = place(model, "camera_link")
    assert straight.translation == pytest.approx((AHEAD_M, 0.0, HEIGHT_M))
    assert straight.rpy_rad == pytest.approx((0.0, 0.0, 0.0))


def test_the_head_turns_on_the_spot_to_the_left_and_up(model: RobotModel) -> None:
    quarter = math.pi / 2
    left = place(model, "camera_link", pan_joint=quarter)
    assert left.point((1.0, 0.0, 0.0)) == pytest.approx((AHEAD_M, 1.0, HEIGHT_M))
    up = place(model, "camera_link", tilt_joint=quarter)
    assert up.point((1.0, 0.0, 0.0)) == pytest.approx((AHEAD_M, 0.0, HEIGHT_M + 1.0))
    for name in (HEAD_PAN, HEAD_TILT):
        reach = (math.degrees(model.joints[name].lower), math.degrees(model.joints[name].upper))
        assert reach == pytest.approx((HEAD_ANGLE.low, HEAD_ANGLE.high), abs=1e-3)


def test_pictures_look_along_z_with_y_down(model: RobotModel) -> None:
    optical = place(model, "camera_color_optical_frame")
    x, y, z = optical.translation
    assert optical.point((0.0, 0.0, 1.0)) == pytest.approx((x + 1, y, z), abs=1e-5)
    assert optical.point((0.0, 1.0, 0.0)) == pytest.approx((x, y, z - 1), abs=1e-5)


def test_the_sonars_measure_from_the_bumpers(model: RobotModel) -> None:
    ahead = place(model, "sonar_front_link")
    assert ahead.translation[0] == pytest.approx(BODY.length_m - BODY.behind_m)
    assert ahead.point((1.0, 0.0, 0.0))[0] > 1.0
    behind = place(model, "sonar_rear_link")
    assert behind.translation[0] == pytest.approx(-BODY.behind_m)
    assert behind.point((1.0, 0.0, 0.0))[0] < -1.0


def test_every_shape_has_a_colour(model: RobotModel) -> None:
    assert all(visual.colour for link in model.links.values() for visual in link.visuals)

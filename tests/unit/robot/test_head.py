"""The head's joints, and the sizes of the robot's model."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.joints import DRIVE_JOINTS, HEAD_JOINTS
from robot.kinematics import TRACK_M, WHEEL_RADIUS_M, WHEELBASE_M
from robot.limits import Limits
from robot.motion.head import HeadJoint, turn_ms
from robot.wire.lsc16 import PULSE, ServoMove, decode, encode
from space.robot_model import Cylinder, RobotModel
from space.transform import IDENTITY, Transform
from space.urdf import read_urdf

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
        (HeadJoint(1), 0, 1500), (HeadJoint(1), 90, 2500), (HeadJoint(1), -90, 500),
        (HeadJoint(1, reversed=True), 90, 500), (HeadJoint(1, trim_deg=9), 0, 1600),
        (HeadJoint(1, trim_deg=9), -90, 600), (HeadJoint(1, trim_deg=9, reversed=True), 90, 600),
        (HeadJoint(1, turn_deg=270), 90, 2167),
    ],
)  # fmt: skip
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
def test_whatever_is_within_reach_is_a_pulse_that_the_controller_takes(joint: HeadJoint, angle: float) -> None:
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


FILE = Path(__file__).parents[3] / "robot" / "description" / "robot.urdf"
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


def test_every_joint_that_drivers_report_is_there_and_every_other_follows(model: RobotModel) -> None:
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

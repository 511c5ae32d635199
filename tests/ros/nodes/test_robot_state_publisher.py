"""The robot's model in ROS: what is latched, what moves, and what is not believed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pytest
from builtin_interfaces.msg import Time
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from nodes.mock_camera import MockCamera
from nodes.robot_state_publisher import COURSE_ROBOT
from nodes.tof_sonar import TofSonar
from tests.ros.heard_frames import buffer_of, children
from tests.ros.node_process import NodeProcess
from tests.ros.peer import LATCHED, Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.nightly

MODULE = "nodes.robot_state_publisher"
WHEEL, STEERING = "rear_left_wheel_joint", "steering_joint"
ARM = """<robot name='arm'>
  <link name='base'/> <link name='arm'/> <link name='hand'/> <link name='cloud'/>
  <joint name='lift' type='prismatic'> <parent link='base'/> <child link='arm'/>
    <axis xyz='0 0 1'/> <limit lower='0' upper='1' effort='1' velocity='1'/> </joint>
  <joint name='wrist' type='fixed'> <parent link='arm'/> <child link='hand'/>
    <origin xyz='0.1 0 0'/> </joint>
  <joint name='drift' type='floating'> <parent link='base'/> <child link='cloud'/> </joint>
</robot>"""


def joints(position: dict[str, float], stamp_s: int = 0) -> JointState:
    message = JointState(name=list(position), position=list(position.values()))
    message.header.stamp = Time(sec=stamp_s)
    return message


def test_the_description_and_what_is_fixed_wait_for_whoever_comes_late(
    peer: Peer, ros_domain: int
) -> None:
    with NodeProcess(MODULE, ros_domain) as node:
        node.wait_for_words("deck_robot: 13 links, 8 joints move", "/joint_states, /head_state")
        described = peer.hear("/robot_description", String, LATCHED)
        fixed = peer.hear("/tf_static", TFMessage, LATCHED)
        wait_until(lambda: described and fixed, "what is latched")
    assert described[0].data == COURSE_ROBOT.read_text()
    cameras, sonars = (
        str(next(each.default for each in node_type.SETTINGS if each.name == "frame_id"))
        for node_type in (MockCamera, TofSonar)
    )
    assert children(fixed[0]) == {"camera_link", cameras, sonars, "sonar_rear_link"}


def test_a_position_moves_its_link_and_those_that_follow(peer: Peer, ros_domain: int) -> None:
    with NodeProcess(MODULE, ros_domain):
        moved = peer.hear("/tf", TFMessage)
        with peer.saying("/joint_states", joints({WHEEL: 0.5, STEERING: 0.3}, stamp_s=1_000)):
            wait_until(lambda: len(moved) > 2, "the transforms")
    assert children(moved[-1]) == {
        *("rear_left_wheel", "front_left_wheel"),
        *("front_left_knuckle", "front_right_knuckle"),
    }
    buffer = buffer_of([], moved)
    wheel = buffer.find("base_link", "rear_left_wheel")
    assert wheel.translation == pytest.approx((0.0, 0.075, 0.0325))
    assert wheel.rpy_rad == pytest.approx((0.0, 0.5, 0.0))
    # It is steered, and it rolls.
    assert buffer.find("base_link", "front_left_wheel").rpy_rad == pytest.approx((0.0, 0.5, 0.3))
    assert moved[0].transforms[0].header.stamp.sec == 1_000, "as the driver says"


def test_the_head_moves_by_its_own_topic(peer: Peer, ros_domain: int) -> None:
    with NodeProcess(MODULE, ros_domain):
        fixed = peer.hear("/tf_static", TFMessage, LATCHED)
        moved = peer.hear("/tf", TFMessage)
        with peer.saying("/head_state", joints({"pan_joint": math.pi / 2, "tilt_joint": 0.0})):
            wait_until(lambda: fixed and moved, "the transforms")
    camera = buffer_of(fixed, moved).find("base_link", "camera_link")
    assert camera.point((1.0, 0.0, 0.0)) == pytest.approx((0.15, 1.0, 0.25))


def test_what_is_no_position_is_said_and_not_published(peer: Peer, ros_domain: int) -> None:
    with NodeProcess(MODULE, ros_domain) as node:
        moved = peer.hear("/tf", TFMessage)
        uneven = JointState(name=[WHEEL, STEERING], position=[1.0])
        speeds = JointState(name=[WHEEL], velocity=[1.0])
        strange = joints({"rear_left_wheel_joint": math.nan, "elbow\x1b[2J": 1.0, "pan_joint": 0.1})
        with peer.saying("/joint_states", uneven):
            node.wait_for_words("/joint_states is ignored: it has 2 names and 1 positions")
        with peer.saying("/joint_states", speeds):
            node.wait_for_words("it has speeds, but no positions")
        # A head that does not know where it is says nothing.
        unknown = JointState(name=["tilt_joint"])
        with peer.saying("/head_state", unknown), peer.saying("/joint_states", strange):
            node.wait_for_words("rear_left_wheel_joint cannot be at nan", "no joint elbow␛[2J")
            wait_until(lambda: len(moved) > 3, "the joint that is fine")
        assert node.output.count("elbow") == 1
    assert {child for message in moved for child in children(message)} == {"head_pan_link"}


def test_a_position_that_is_not_repeated_is_not_held_for_ever(peer: Peer, ros_domain: int) -> None:
    with NodeProcess(MODULE, ros_domain, params={"hold_s": 0.5}):
        moved = peer.hear("/tf", TFMessage)
        with peer.saying("/head_state", joints({"pan_joint": 0.1})):
            with peer.saying("/joint_states", joints({WHEEL: 0.5})):
                wait_until(lambda: moved and "rear_left_wheel" in children(moved[-1]), "the wheel")
            wait_until(lambda: children(moved[-1]) == {"head_pan_link"}, "only the head")


def test_joints_start_at_zero_where_that_is_asked_for(peer: Peer, ros_domain: int) -> None:
    params: dict[str, object] = {"start_at_zero": True, "leave_out": "'camera_link head_pan_link'"}
    with NodeProcess(MODULE, ros_domain, params=params):
        fixed = peer.hear("/tf_static", TFMessage, LATCHED)
        moved = peer.hear("/tf", TFMessage)
        wait_until(lambda: fixed and moved, "the transforms")
    assert len(children(moved[0])) == 7
    assert "head_pan_link" not in children(moved[0])
    assert "camera_link" not in children(fixed[0]), "another node says where it is"
    assert "camera_color_optical_frame" in children(fixed[0])


def test_it_warns_of_joints_that_nobody_reports(ros_domain: int) -> None:
    with NodeProcess(MODULE, ros_domain, lang="ru") as node:
        node.wait_for_words("[WARN]", "steering_joint, pan_joint, tilt_joint", "положени")


def test_another_robot_from_a_file(peer: Peer, ros_domain: int, tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text(ARM)
    with NodeProcess(MODULE, ros_domain, params={"urdf_file": file}) as node:
        node.wait_for_words("joint drift is floating: the place of cloud has to come from")
        fixed = peer.hear("/tf_static", TFMessage, LATCHED)
        moved = peer.hear("/tf", TFMessage)
        with peer.saying("/joint_states", joints({"lift": 0.5, "drift": 1.0})):
            wait_until(lambda: fixed and moved, "the transforms")
    assert buffer_of(fixed, moved).find("base", "hand").translation == pytest.approx((0.1, 0, 0.5))
    assert "cloud" not in children(moved[-1])


def test_a_file_is_published_as_utf_8_whatever_it_is_written_in(
    peer: Peer, ros_domain: int, tmp_path: Path
) -> None:
    file = tmp_path / "arm.urdf"
    first = '<?xml version="1.0" encoding="{}"?>\n'
    text = ARM.replace("hand", "рука")
    file.write_bytes((first.format("windows-1251") + text).encode("windows-1251"))
    with NodeProcess(MODULE, ros_domain, params={"urdf_file": file}):
        described = peer.hear("/robot_description", String, LATCHED)
        fixed = peer.hear("/tf_static", TFMessage, LATCHED)
        wait_until(lambda: described and fixed, "what is latched")
    assert described[0].data == first.format("UTF-8") + text
    assert children(fixed[0]) == {"рука"}


REFUSED = {
    "no file": ({"urdf_file": "/nowhere.urdf"}, "cannot read /nowhere.urdf: No such file"),
    "no robot": ({"robot_description": "'<robot/>'"}, "robot_description, line 1: <robot> has no"),
    "two robots": (
        {"robot_description": "'<robot/>'", "urdf_file": "/x"},
        "robot_description or urdf_file, not both",
    ),
    "no such link": ({"leave_out": "camera"}, "no link camera; its links are base_link,"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_it_refuses_to_start_without_a_robot(ros_domain: int, case: str) -> None:
    params, words = REFUSED[case]
    with NodeProcess(MODULE, ros_domain, params=dict(params)) as node:
        assert node.wait() == 2
        assert words in node.output
        assert "Traceback" not in node.output

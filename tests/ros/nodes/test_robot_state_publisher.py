"""The robot's model in ROS: what is latched, and what moves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import pytest
from builtin_interfaces.msg import Time
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from nodes.mock_camera import MockCamera
from nodes.robot_state_publisher import COURSE_ROBOT
from nodes.tof_sonar import TofSonar
from space.buffer import Stamped, TransformBuffer
from space.transform import Transform
from tests.ros.node_process import NodeProcess
from tests.ros.peer import LATCHED, Peer
from tests.waiting import wait_until


def children(message: TFMessage) -> set[str]:
    """The frames of which it says where they are."""
    return {transform.child_frame_id for transform in message.transforms}


def buffer_of(fixed: Sequence[TFMessage], moved: Sequence[TFMessage]) -> TransformBuffer:
    """All that was heard of /tf_static and of /tf."""
    buffer = TransformBuffer(keep_s=math.inf)
    for static, messages in ((True, fixed), (False, moved)):
        for one in (one for message in messages for one in message.transforms):
            place, turn, stamp = one.transform.translation, one.transform.rotation, one.header.stamp
            transform = Transform.of((place.x, place.y, place.z), (turn.x, turn.y, turn.z, turn.w))
            stamp_s = stamp.sec + stamp.nanosec / 1e9
            found = Stamped(one.header.frame_id, one.child_frame_id, stamp_s, transform, static=static)
            buffer.add([found])
    return buffer


pytestmark = pytest.mark.nightly

MODULE = "nodes.robot_state_publisher"
WHEEL, STEERING = "rear_left_wheel_joint", "steering_joint"


def joints(position: dict[str, float], stamp_s: int = 0) -> JointState:
    message = JointState(name=list(position), position=list(position.values()))
    message.header.stamp = Time(sec=stamp_s)
    return message


def test_the_description_and_what_is_fixed_wait_for_whoever_comes_late(peer: Peer, ros_domain: int) -> None:
    with NodeProcess(MODULE, ros_domain) as node:
        node.wait_for_words("deck_robot: 13 links, 8 joints move", "/joint_states, /head_state")
        described = peer.hear("/robot_description", String, LATCHED)
        fixed = peer.hear("/tf_static", TFMessage, LATCHED)
        wait_until(lambda: described and fixed, "what is latched")
    assert described[0].data == COURSE_ROBOT.read_text()
    cameras, sonars = (str(node_type.settings()["frame_id"].default) for node_type in (MockCamera, TofSonar))
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


ARM = """<robot name='arm'>
  <link name='base'/> <link name='arm'/> <link name='hand'/> <link name='cloud'/>
  <joint name='lift' type='prismatic'> <parent link='base'/> <child link='arm'/>
    <axis xyz='0 0 1'/> <limit lower='0' upper='1' effort='1' velocity='1'/> </joint>
  <joint name='wrist' type='fixed'> <parent link='arm'/> <child link='hand'/>
    <origin xyz='0.1 0 0'/> </joint>
  <joint name='drift' type='floating'> <parent link='base'/> <child link='cloud'/> </joint>
</robot>"""


def test_a_file_is_published_as_utf_8_whatever_it_is_written_in(peer: Peer, ros_domain: int, tmp_path: Path) -> None:
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

"""The frames of profiles/robot.yaml are one tree, in which wheels and head turn as they do."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import pytest
from example_interfaces.srv import AddTwoInts
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from robot.joints import DRIVE_JOINTS
from space.urdf import read_urdf
from tests.ros.heard_frames import buffer_of, children
from tests.ros.peer import LATCHED
from tests.ros.robot_nodes import RobotNodes
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from space.transform import Transform

pytestmark = pytest.mark.nightly

ALL_LATCHED = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.fixture
def nodes(ros_domain: int, tmp_path: Path) -> Iterator[RobotNodes]:
    """What says where the parts of the robot are."""
    nodes = RobotNodes(ros_domain, tmp_path / "devices")
    try:
        nodes.start("chassis", "head_controller", "camera_tf", "robot_state_publisher")
        yield nodes
    finally:
        nodes.close()


def test_all_frames_are_one_tree_and_turn_with_the_robot(nodes: RobotNodes) -> None:
    peer = nodes.peer
    fixed = peer.hear("/tf_static", TFMessage, ALL_LATCHED)
    moved = peer.hear("/tf", TFMessage)
    described = peer.hear("/robot_description", String, LATCHED)
    wait_until(lambda: described, "the robot's model")
    model = read_urdf(described[0].data)

    def found(frame: str) -> Transform:
        return buffer_of(list(fixed), list(moved[-40:])).find("base_link", frame)

    def parents() -> dict[str, set[str]]:
        named: dict[str, set[str]] = {}
        for message in (*fixed, *moved):
            for one in message.transforms:
                named.setdefault(one.child_frame_id, set()).add(one.header.frame_id)
        return named

    # The head has not moved yet, and is taken to look straight ahead.
    wait_until(lambda: parents().keys() >= {*model.links}, "where every link is")
    assert all(len(each) == 1 for each in parents().values()), parents()
    assert parents().keys() == {*model.links}, "odom is the root"
    latched = [child for message in fixed for child in children(message)]
    assert len(latched) == len(set(latched)), "two nodes say where the same frame is"
    assert found("camera_link").translation == pytest.approx((0.15, 0.0, 0.25))

    request = AddTwoInts.Request(a=90, b=0)
    assert peer.ask("/set_head_position", AddTwoInts, request).sum == 1
    wait_until(
        lambda: abs(found("camera_link").rpy_rad[2] - math.pi / 2) < 0.01, "a look to the left"
    )
    assert found("camera_link").translation == pytest.approx((0.15, 0.0, 0.25))

    command = JointState(name=list(DRIVE_JOINTS))
    command.position, command.velocity = [math.nan, math.nan, 0.3], [4.0, 4.5, math.nan]

    def stamped() -> JointState:
        command.header.stamp = peer.node.get_clock().now().to_msg()
        return command

    before = found("rear_left_wheel")
    nodes.wheels.command("/wheel_commands", stamped)
    wait_until(lambda: found("rear_left_wheel") != before, "a wheel that turns")
    wait_until(
        lambda: abs(found("front_right_wheel").rpy_rad[2]) > 0.2, "front wheels that are steered"
    )

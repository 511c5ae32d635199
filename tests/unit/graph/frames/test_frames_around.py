"""What an update tells of frames besides them: which headers name them, where else they are."""

from __future__ import annotations

from dataclasses import replace

import pytest

from graph.data import EndpointInfo, FrameRow, GraphUpdate, TopicRow, Trouble
from graph.frames.around import is_settling, surroundings
from space.buffer import Stamped
from space.transform import IDENTITY

TF_MESSAGE = "tf2_msgs/msg/TFMessage"
STATIC = TopicRow("/tf_static", (TF_MESSAGE,), 1, 0)
CAMERA = FrameRow(Stamped("base_link", "camera_link", 0.0, IDENTITY, static=True), 1)
ODOMETRY = FrameRow(Stamped("odom", "base_link", 0.0, IDENTITY), 1)


def update(*topics: TopicRow, frames: tuple[FrameRow, ...] = (ODOMETRY,)) -> GraphUpdate:
    return GraphUpdate(0.0, topics=topics, frames=frames)


@pytest.mark.parametrize(
    ("row", "settling"),
    [
        (STATIC, True),
        # What came while another screen was in front comes again.
        (replace(STATIC, count=3), True),
        (replace(STATIC, trouble=Trouble.QUIET), False),
        (replace(STATIC, publishers=0, trouble=Trouble.NO_PUBLISHER), False),
    ],
)
def test_static_frames_are_waited_for_while_they_may_come(row: TopicRow, settling: bool) -> None:
    assert is_settling(update(row)) == settling
    assert not is_settling(update(row, frames=(ODOMETRY, CAMERA)))


def test_topics_tell_which_frames_headers_name_and_where_else_frames_are() -> None:
    image = TopicRow("/image", ("sensor_msgs/msg/Image",), 1, 0, frame_id="camera_lnk")
    arm = TopicRow("/arm/tf", (TF_MESSAGE,), 1, 2)
    gone = TopicRow("/old/tf", (TF_MESSAGE,), 0, 2)
    ends = tuple(
        EndpointInfo(node, TF_MESSAGE, "reliable", durability)
        for node, durability in (("/good", "transient_local"), ("/bad", "volatile"))
    )
    found = surroundings(update(image, arm, gone, replace(STATIC, published_by=ends)))
    assert found.named == {"/image": "camera_lnk"}
    assert found.elsewhere == {"/arm/tf": 2}
    assert found.volatile == ("/bad",)
    assert not found.simulated
    clock = TopicRow("/clock", ("rosgraph_msgs/msg/Clock",), 1, 0)
    assert surroundings(update(clock)).simulated

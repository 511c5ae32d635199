"""Frames of a robot as they were written down: one in order, and one with everything wrong."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from graph.data import FrameRow, GraphUpdate, TopicRow
from space.buffer import Stamped
from space.transform import Transform
from tests.tui.recorded import NOW_S, RecordedGraph, RecordedOpener, RecordedSession, lesson_update
from text.sentences import say

_TF = "tf2_msgs/msg/TFMessage"


def frame(
    parent: str,
    child: str,
    place: tuple[float, float, float] = (0.0, 0.0, 0.0),
    yaw_deg: float = 0.0,
    *,
    static: bool = False,
    **more: Any,
) -> FrameRow:
    """A frame that comes as it should, but for what is said otherwise."""
    transform = Transform.from_rpy(place, (0.0, 0.0, math.radians(yaw_deg)))
    row = FrameRow(
        Stamped(parent, child, NOW_S, transform, static),
        count=1 if static else 250,
        hz=None if static else 50.0,
        age_s=12.0 if static else 0.02,
        delay_s=0.001,
        publishers=("/robot_state_publisher",) if static else ("/chassis",),
    )
    return replace(row, **more)


ROBOT = (
    frame("odom", "base_link", (2.0, 1.0, 0.0), 90.0),
    frame("base_link", "camera_link", (0.15, 0.0, 0.25), static=True),
    frame("head_tilt", "eye", (0.02, 0.0, 0.03), static=True),
    frame("base_link", "head_pan", (0.05, 0.0, 0.2), 30.0, hz=10.0, publishers=("/head",)),
    frame("head_pan", "head_tilt", (0.0, 0.0, 0.04), hz=10.0, publishers=("/head",)),
    frame("base_link", "sonar_front", (0.2, 0.0, 0.1), static=True),
    frame("base_link", "wheel_left", (0.0, 0.12, 0.03)),
    frame("base_link", "wheel_right", (0.0, -0.12, 0.03)),
)
TROUBLES = (
    *ROBOT[:3],
    replace(ROBOT[3], age_s=7.4, newest=replace(ROBOT[3].newest, stamp_s=NOW_S - 7.4)),
    replace(ROBOT[4], age_s=7.4, newest=replace(ROBOT[4].newest, stamp_s=NOW_S - 7.4)),
    replace(ROBOT[5], publishers=(), gone="/robot_state_publisher"),
    replace(ROBOT[6], publishers=("/chassis", "/robot_state_publisher"), contested=True),
    replace(ROBOT[7], fault=say("its translation is not finite: {numbers}", numbers="nan, 0, 0"), faults=250),
    frame("map", "base_link", (1.0, 0.0, 0.0), publishers=("/slam",), hz=5.0),
    frame("camera_lnk", "lens", static=True, publishers=("/camera", "/camera"), moved=True),
    frame("gripper", "finger", publishers=("/arm", "/hand"), certain=False),
    frame("finger", "gripper", publishers=("/arm",)),
)


def topics(image_frame: str = "camera_link") -> tuple[TopicRow, ...]:
    """The topics of such a robot, one with a header."""
    return (
        TopicRow("/camera/image", ("sensor_msgs/msg/Image",), 1, 0, frame_id=image_frame),
        TopicRow("/tf", (_TF,), 2, 1, count=250),
        TopicRow("/tf_static", (_TF,), 1, 1, count=2),
    )


def frames_update(frames: Sequence[FrameRow] = ROBOT, rows: Sequence[TopicRow] = topics()) -> GraphUpdate:
    return replace(lesson_update(topics=tuple(rows), samples={}), frames=tuple(frames))


def with_frames(frames: Sequence[FrameRow] = ROBOT, rows: Sequence[TopicRow] = topics()) -> RecordedOpener:
    graph = RecordedGraph(frames_update(frames, rows))
    return RecordedOpener(RecordedSession(lines=()), graph)

"""Wheels and head whose messages are about other joints: which come, and which are awaited."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from tests.tui.app_runs import opened
from tests.tui.panel_stage import rows
from tests.tui.recorded import (
    RecordedGraph,
    RecordedOpener,
    joints,
    lesson_samples,
    lesson_update,
)
from tui.panels.head.widget import HeadView
from tui.panels.joints import ANOTHER_S, Joints
from tui.panels.wheels.widget import WheelsView

if TYPE_CHECKING:
    from graph.data import Sample
    from tui.widgets.drawing import Drawing

TOPIC = "/wheel_commands"
AWAITED = ("rear_left_wheel_joint", "rear_right_wheel_joint")
OTHER = joints(TOPIC, left_wheel=(0.0, 1.0), right_wheel=(0.0, 1.0))
READ = joints(TOPIC, rear_left_wheel_joint=(0.0, 1.0))


def heard(*samples: tuple[Sample, float]) -> Joints:
    known = Joints(TOPIC, AWAITED)
    for one, at_s in samples:
        known.hear(replace(one, received_s=at_s), read=one is READ)
    return known


@pytest.mark.parametrize(
    ("kind", "other", "came", "awaited"),
    [
        (
            WheelsView,
            OTHER,
            "/wheel_commands: received left_wheel, right_wheel",
            "expected: rear_left_wheel_joint, rear_right_wheel_joint",
        ),
        (
            HeadView,
            joints("/head_state", yaw=(0.1, 0.0), pitch=(0.2, 0.0)),
            "/head_state: received yaw, pitch",
            "expected: pan_joint, tilt_joint",
        ),
        (
            HeadView,
            joints("/head_state"),
            "/head_state: received no joint names",
            "expected: pan_joint, tilt_joint",
        ),
    ],
)
async def test_the_panel_says_which_joints_come_and_which_are_awaited(
    kind: type[Drawing], other: Sample, came: str, awaited: str
) -> None:
    samples = {**lesson_samples(), other.topic: (other,)}
    opener = RecordedOpener(graph=RecordedGraph(lesson_update(samples=samples)))
    async with opened(opener, size=(160, 60)) as (app, pilot):
        await pilot.pause()
        view = app.screen.query_one(kind)
        words = " ".join(" ".join(rows(view)).split())
        assert "messages arrive, but with other joint names" in words
        assert came in words
        assert awaited in words
        assert "waiting for the first message" not in words
        opener.graph.show(lesson_update())
        await pilot.pause()
        await pilot.pause()
        assert "have come" not in " ".join(rows(view))


def test_values_give_way_once_nothing_but_other_joints_comes() -> None:
    assert heard((READ, 5.0)).placeholder is None
    assert heard((READ, 5.0), (OTHER, 5.0 + ANOTHER_S / 2)).placeholder is None
    told = heard((READ, 5.0), (OTHER, 5.0 + ANOTHER_S)).placeholder
    assert told is not None
    assert "left_wheel" in told.detail
    assert heard((OTHER, 5.0), (READ, 5.1)).placeholder is None

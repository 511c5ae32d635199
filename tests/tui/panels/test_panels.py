"""What panels say where other messages come than they read, and what they ask for unseen."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from graph.data import GraphUpdate, Sample, Trouble
from robot.topics import CAMERA
from tests.tui.panel_stage import rows
from tests.tui.recorded import (
    RecordedGraph,
    RecordedOpener,
    RecordedSession,
    joints,
    lesson_samples,
    lesson_update,
    sample,
)
from tests.tui.recorded_lesson import NOW_S, TOPICS
from tests.tui.recorded_map import MAP_SESSION, map_update, reading
from tests.tui.snapshots import opened, settle
from tests.waiting import until
from tui.panels.camera import CameraPanel
from tui.panels.head import HeadView
from tui.panels.sonar import Sonar
from tui.panels.wheels import WheelsView
from tui.widgets.drawing import Drawing
from tui.widgets.image_view import ImageView

TOPIC = "/wheel_commands"
OTHER = joints(TOPIC, left_wheel=(0.0, 1.0), right_wheel=(0.0, 1.0))


@pytest.mark.parametrize(
    ("kind", "other", "came", "awaited"),
    [
        (WheelsView, OTHER, "left_wheel, right_wheel", "rear_left_wheel_joint, rear_right_wheel"),
        (HeadView, joints("/head_state"), "no joint names", "pan_joint, tilt_joint"),
    ],
)
async def test_the_panel_says_which_joints_come_and_which_are_awaited(
    kind: type[Drawing], other: Sample, came: str, awaited: str
) -> None:
    samples = {**lesson_samples(), other.topic: (other,)}
    opener = RecordedOpener(graph=RecordedGraph(lesson_update(samples=samples)))
    async with opened(opener, size=(160, 60)) as (app, pilot):
        await pilot.pause()
        words = " ".join(" ".join(rows(app.screen.query_one(kind))).split())
        assert f"{other.topic}: received {came}" in words
        assert f"expected: {awaited}" in words
        assert "waiting for the first message" not in words


STRING = "std_msgs/msg/String"


async def test_another_type_is_told_and_not_waited_for() -> None:
    topic = "/camera/color/image_raw"
    words = sample(topic, STRING, {"data": "1.5"})
    opener = RecordedOpener(graph=RecordedGraph(lesson_update(samples={topic: (words,)})))
    async with opened(opener, size=(160, 60)) as (app, pilot):
        widget = app.screen.query_one(CameraPanel).children[0]

        async def told() -> str:
            await settle(pilot)
            return " ".join(" ".join(rows(widget)).split())

        assert f"{topic}: std_msgs/String comes; expected: sensor_msgs/Image" in await told()
        # A look at which nothing has come changes nothing.
        opener.graph.show(lesson_update(samples={}))
        assert "of another type" in await told()
        opener.graph.show(lesson_update())
        assert "std_msgs/String" not in await told()


def with_map() -> RecordedOpener:
    return RecordedOpener(RecordedSession(MAP_SESSION), RecordedGraph(map_update()))


def said(one: Sample) -> GraphUpdate:
    return replace(map_update(), samples={one.topic: (one,)})


async def test_the_trend_of_a_sonar_has_no_gap_where_the_tab_was_another() -> None:
    opener = with_map()
    async with opened(opener) as (app, pilot):
        gauge = app.screen.query_one("#front", Sonar)
        await pilot.press("2")
        await settle(pilot)
        for second in range(1, 41):
            one = replace(reading("front", 0.2), received_s=NOW_S + second)
            opener.graph.show(said(one))
            await pilot.pause()
        await pilot.press("1")
        await settle(pilot)
        assert "STOP" in rows(gauge)[0]
        assert list(gauge._values)[-40:] == [0.2] * 40


COMPRESSED = "sensor_msgs/msg/CompressedImage"


def with_row(*samples: Sample, **changes: Any) -> RecordedGraph:
    """The lesson with a camera whose row is changed, and of which this comes."""
    rows = (replace(row, **changes) if row.name == CAMERA else row for row in TOPICS)
    return RecordedGraph(lesson_update(topics=tuple(rows), samples={CAMERA: samples} if samples else {}))


async def test_a_camera_on_another_page_is_not_asked_for() -> None:
    opener = RecordedOpener()
    async with opened(opener, size=(80, 24)) as (app, pilot):
        panel = app.screen.query_one(CameraPanel)
        turns = 0
        for _ in range(app.screen.pages):  # type: ignore[attr-defined]
            await settle(pilot)
            assert opener.graph.wanted.pictures == ({CAMERA} if panel.display else set())
            turns += not panel.display
            await pilot.press("v")
        assert turns
    assert CAMERA not in opener.graph.wanted.watched


async def test_a_bomb_is_refused_in_words() -> None:
    value = {"format": "jpeg", "data": b"\xff\xd8\xff\xc0\x00\x11\x08\xff\xff\xff\xff" + bytes(9)}
    graph = with_row(sample(CAMERA, COMPRESSED, value))
    async with opened(RecordedOpener(graph=graph)) as (app, _pilot):
        view = app.screen.query_one(CameraPanel).query_one(ImageView)
        await until(lambda: view.words[0] == "this picture cannot be shown", "the refusal")
        assert "65535 x 65535 is not decoded" in view.words[1]


async def test_pictures_that_get_lost_are_told_from_a_silent_camera() -> None:
    graph = with_row(trouble=Trouble.QUIET, age_s=None, raw_from_afar=True)
    async with opened(RecordedOpener(graph=graph)) as (app, pilot):
        await settle(pilot)
        headline, detail = app.screen.query_one(CameraPanel).query_one(ImageView).words
        assert headline == "no whole picture comes over the network"
        assert "or the camera is silent" in detail

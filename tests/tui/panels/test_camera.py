"""The camera: asked for while it is in sight, raw or compressed, and words where nothing comes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from graph.data import Sample, Trouble
from robot.topics import CAMERA
from tests.tui.app_runs import opened
from tests.tui.recorded import RecordedGraph, RecordedOpener, lesson_update, sample
from tests.tui.recorded_lesson import TOPICS
from tests.tui.snapshots import settle
from tests.tui.topics_stage import jpeg_message
from tests.waiting import until
from tui.panels.camera import CameraPanel
from tui.widgets.image_view import ImageView

COMPRESSED = "sensor_msgs/msg/CompressedImage"


def with_row(*samples: Sample, **changes: Any) -> RecordedGraph:
    """The lesson with a camera whose row is changed, and of which this comes."""
    rows = (replace(row, **changes) if row.name == CAMERA else row for row in TOPICS)
    return RecordedGraph(
        lesson_update(topics=tuple(rows), samples={CAMERA: samples} if samples else {})
    )


async def test_a_camera_on_another_page_is_not_asked_for() -> None:
    opener = RecordedOpener()
    async with opened(opener, size=(80, 24)) as (app, pilot):
        panel = app.screen.query_one(CameraPanel)
        turns = 0
        for _ in range(app.screen.pages):  # type: ignore[attr-defined]
            await settle(pilot)
            assert opener.graph.pictures == ({CAMERA} if panel.display else set())
            turns += not panel.display
            await pilot.press("v")
        assert turns
    assert CAMERA not in opener.graph.watched


async def test_a_compressed_picture_is_shown_with_the_size_of_the_camera() -> None:
    value = jpeg_message()
    value["format"] = "bgr8; jpeg compressed bgr8; of 1280x960"
    graph = with_row(sample(CAMERA, COMPRESSED, value), pictures_from=f"{CAMERA}/_deck/compressed")
    async with opened(RecordedOpener(graph=graph)) as (app, pilot):
        view = app.screen.query_one(CameraPanel).query_one(ImageView)
        await until(lambda: view.has_picture, "the picture")
        await settle(pilot)
        assert view.caption.startswith("1280×960")


async def test_a_bomb_is_refused_in_words() -> None:
    value = {"format": "jpeg", "data": b"\xff\xd8\xff\xc0\x00\x11\x08\xff\xff\xff\xff" + bytes(9)}
    graph = with_row(sample(CAMERA, COMPRESSED, value))
    async with opened(RecordedOpener(graph=graph)) as (app, _pilot):
        view = app.screen.query_one(CameraPanel).query_one(ImageView)
        await until(lambda: view.words[0] == "this picture cannot be shown", "the refusal")
        assert "65535 x 65535 is not decoded" in view.words[1]


async def test_pictures_that_get_lost_are_told_from_a_silent_camera() -> None:
    graph = with_row(trouble=Trouble.QUIET, age_s=None, facts={"raw": CAMERA})
    async with opened(RecordedOpener(graph=graph)) as (app, pilot):
        await settle(pilot)
        headline, detail = app.screen.query_one(CameraPanel).query_one(ImageView).words
        assert headline == "no whole picture comes over the network"
        assert "or the camera is silent" in detail

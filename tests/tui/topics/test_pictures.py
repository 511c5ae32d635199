"""Images on the screen of topics: shown as they come, the late ones left out."""

from __future__ import annotations

import threading
from collections.abc import AsyncIterator
from dataclasses import replace
from typing import Any

import pytest
from textual.app import App, ComposeResult

from graph.pictures.picture import Picture
from graph.pictures.reading import read_picture
from tests.tui.recorded import NOW_S, TOPICS, lesson_update, sample
from tests.tui.topics_room import (
    CAMERA,
    SONAR,
    Room,
    depth_message,
    jpeg_message,
    opened,
    with_camera,
)
from tui.topics import pictures as topics_pictures
from tui.topics.detail import TopicDetail
from tui.topics.pictures import TopicPictures


@pytest.fixture
async def room() -> AsyncIterator[Room]:
    async with opened() as room:
        yield room


async def test_an_image_is_a_picture_and_can_be_a_tree(room: Room) -> None:
    await room.choose(CAMERA)
    await room.show(lesson_update())
    assert room.as_picture()
    assert room.screen.detail.picture.caption == "bgr8 640×480 · 10.0 Hz"
    await room.pilot.press("i")
    assert not room.as_picture()
    assert "(921600 bytes)" in room.echo()
    await room.show(lesson_update())
    assert not room.as_picture()


async def test_a_picture_that_cannot_be_shown_is_told(room: Room) -> None:
    await room.choose(CAMERA)
    odd = {"width": 2, "height": 2, "step": 4, "encoding": "nv21", "data": b"1234"}
    await room.show(
        lesson_update(samples={CAMERA: (sample(CAMERA, "sensor_msgs/msg/Image", odd),)})
    )
    headline, detail = room.screen.detail.picture.words
    assert headline == "pictures of the encoding nv21 cannot be shown"
    assert "rgb8" in detail


async def test_depth_has_a_scale_in_metres(room: Room) -> None:
    await room.choose(CAMERA)
    await room.show(with_camera("sensor_msgs/msg/Image", depth_message()))
    view = room.screen.detail.picture
    assert view.caption == "16UC1 64×48 · 10.0 Hz"
    scale = view.render_line(view.size.height - 2).text
    assert scale.strip().startswith("near 0.5 m")
    assert scale.strip().endswith("4 m far")


async def test_no_picture_of_the_topic_before_stays_while_the_line_is_busy(room: Room) -> None:
    await room.choose(CAMERA)
    await room.show(with_camera("sensor_msgs/msg/Image", depth_message()))
    view = room.screen.detail.picture
    before = view.has_picture
    assert before
    room.app.bandwidth.behind = True
    await room.choose("/drive")
    assert not view.has_picture
    await room.choose(CAMERA)
    await room.show(with_camera("sensor_msgs/msg/CompressedImage", jpeg_message()))
    await room.decoded()
    assert view.caption == "jpeg 640×480 · 10.0 Hz"


async def test_a_compressed_image_is_decoded_and_shown(room: Room) -> None:
    await room.choose(CAMERA)
    await room.show(with_camera("sensor_msgs/msg/CompressedImage", jpeg_message()))
    await room.decoded()
    assert room.screen.detail.picture.caption == "jpeg 640×480 · 10.0 Hz"


async def test_a_compressed_image_that_is_cut_short_says_so(room: Room) -> None:
    await room.choose(CAMERA)
    await room.show(with_camera("sensor_msgs/msg/CompressedImage", jpeg_message(5000)))
    await room.decoded()
    headline, detail = room.screen.detail.picture.words
    assert headline == "this picture cannot be shown"
    assert detail == "the JPEG data are cut short: no end in 5000 bytes"


async def test_late_pictures_are_left_out_while_one_is_decoded(
    room: Room, monkeypatch: pytest.MonkeyPatch
) -> None:
    release = threading.Event()
    seen: list[object] = []

    def slow(type_name: str, value: Any, fit: Any) -> Picture:
        seen.append(value["number"])
        assert release.wait(30)
        return read_picture(type_name, value, fit)

    monkeypatch.setattr(topics_pictures, "read_picture", slow)
    await room.choose(CAMERA)
    for number in range(5):
        value = {**jpeg_message(), "number": number}
        await room.show(with_camera("sensor_msgs/msg/CompressedImage", value))
    release.set()
    await room.decoded()
    assert seen == [0, 4]


class DetailApp(App[None]):
    """Nothing but the detail of a topic."""

    def compose(self) -> ComposeResult:
        """The detail."""
        yield TopicDetail()


@pytest.mark.parametrize("wanted", [True, False])
async def test_a_picture_that_nobody_wants_any_more_when_it_is_decoded_is_not_shown(
    wanted: bool,
) -> None:
    async with DetailApp().run_test() as pilot:
        detail = pilot.app.query_one(TopicDetail)
        pictures = TopicPictures(detail, lambda _sample: wanted, lambda: None)
        pictures.show(sample(CAMERA, "sensor_msgs/msg/CompressedImage", jpeg_message()))
        await pilot.app.workers.wait_for_complete()
        assert detail.picture.has_picture is wanted


async def test_a_picture_asks_for_ten_updates_a_second_and_rates_stay_as_they_are(
    room: Room,
) -> None:
    await room.choose(CAMERA)
    assert room.graph.period_s == 0.25
    await room.show(lesson_update())
    assert room.graph.period_s == 0.1
    faster = [replace(one, hz=99.0) for one in TOPICS]
    await room.show(lesson_update(time_s=NOW_S + 0.1, topics=tuple(faster)))
    assert room.screen.table.chosen_row.hz == 10.0  # type: ignore[union-attr]
    await room.show(lesson_update(time_s=NOW_S + 0.2, topics=tuple(faster)))
    assert room.screen.table.chosen_row.hz == 99.0  # type: ignore[union-attr]
    for key in ("p", "e", "i"):
        await room.pilot.press(key)
        await room.pilot.pause()
        assert room.graph.period_s == 0.25, key
        await room.pilot.press(key)
        await room.pilot.pause()
        assert room.graph.period_s == 0.1, key
    await room.choose(SONAR)
    assert room.graph.period_s == 0.25

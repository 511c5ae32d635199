"""Images on the screen of topics: shown as they come, the late ones left out."""

from __future__ import annotations

import threading
from collections.abc import AsyncIterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from graph.pictures.picture import Picture
from graph.pictures.reading import read_picture
from tests.tui.recorded import NOW_S, TOPICS, lesson_update, sample
from tests.tui.topics_stage import (
    CAMERA,
    SONAR,
    TopicsStage,
    depth_message,
    jpeg_message,
    opened,
    with_camera,
)
from tui.widgets import newest_picture


@pytest.fixture
async def stage() -> AsyncIterator[TopicsStage]:
    async with opened() as stage:
        yield stage


async def test_an_image_is_a_picture_and_can_be_a_tree(stage: TopicsStage) -> None:
    await stage.choose(CAMERA)
    await stage.show(lesson_update())
    assert stage.as_picture()
    assert stage.screen.detail.picture.caption == "bgr8 640×480 · 10.0 Hz"
    await stage.pilot.press("i")
    assert not stage.as_picture()
    assert "(921600 bytes)" in stage.echo()
    await stage.show(lesson_update())
    assert not stage.as_picture()


async def test_a_picture_that_cannot_be_shown_is_told(stage: TopicsStage) -> None:
    await stage.choose(CAMERA)
    odd = {"width": 2, "height": 2, "step": 4, "encoding": "nv21", "data": b"1234"}
    await stage.show(
        lesson_update(samples={CAMERA: (sample(CAMERA, "sensor_msgs/msg/Image", odd),)})
    )
    headline, detail = stage.screen.detail.picture.words
    assert headline == "pictures of the encoding nv21 cannot be shown"
    assert "rgb8" in detail


async def test_depth_has_a_scale_in_metres(stage: TopicsStage) -> None:
    await stage.choose(CAMERA)
    await stage.show(with_camera("sensor_msgs/msg/Image", depth_message()))
    view = stage.screen.detail.picture
    assert view.caption == "16UC1 64×48 · 10.0 Hz"
    scale = view.render_line(view.size.height - 2).text
    assert scale.strip().startswith("near 0.5 m")
    assert scale.strip().endswith("4 m far")


@pytest.mark.parametrize(
    ("encoding", "kind", "reading"),
    [
        ("32FC1", "<f4", np.nan),
        ("32FC1", "<f4", np.inf),
        ("32FC1", "<f4", 0.0),
        ("16UC1", "<u2", 0),
    ],
)
async def test_depth_without_a_distance_says_so_and_is_a_picture_again_with_one(
    stage: TopicsStage, encoding: str, kind: str, reading: float
) -> None:
    await stage.choose(CAMERA)
    numbers = np.full((20, 40), reading, kind)

    async def show() -> None:
        message = {
            "width": 40,
            "height": 20,
            "step": numbers.strides[0],
            "encoding": encoding,
            "is_bigendian": 0,
            "data": numbers.tobytes(),
        }
        shown = sample(CAMERA, "sensor_msgs/msg/Image", message)
        await stage.show(lesson_update(samples={CAMERA: (shown,)}))

    await show()
    assert stage.screen.detail.picture.words == (
        "no valid depth",
        "no reading is a distance: each is NaN, infinite or 0",
    )
    numbers[:] = 2
    await show()
    assert stage.screen.detail.picture.caption.startswith(f"{encoding} 40×20")


async def test_a_compressed_image_is_decoded_and_shown(stage: TopicsStage) -> None:
    await stage.choose(CAMERA)
    await stage.show(with_camera("sensor_msgs/msg/CompressedImage", jpeg_message()))
    await stage.decoded()
    assert stage.screen.detail.picture.caption == "jpeg 640×480 · 10.0 Hz"


async def test_late_pictures_are_left_out_while_one_is_decoded(
    stage: TopicsStage, monkeypatch: pytest.MonkeyPatch
) -> None:
    release = threading.Event()
    seen: list[object] = []

    def slow(type_name: str, value: Any, fit: Any) -> Picture:
        seen.append(value["number"])
        assert release.wait(30)
        return read_picture(type_name, value, fit)

    monkeypatch.setattr(newest_picture, "read_picture", slow)
    await stage.choose(CAMERA)
    for number in range(5):
        value = {**jpeg_message(), "number": number}
        await stage.show(with_camera("sensor_msgs/msg/CompressedImage", value))
    release.set()
    await stage.decoded()
    assert seen == [0, 4]


async def test_a_picture_asks_for_ten_updates_a_second_and_rates_stay_as_they_are(
    stage: TopicsStage,
) -> None:
    await stage.choose(CAMERA)
    assert stage.graph.period_s == 0.25
    await stage.show(lesson_update())
    assert stage.graph.period_s == 0.1
    faster = [replace(one, hz=99.0) for one in TOPICS]
    await stage.show(lesson_update(time_s=NOW_S + 0.1, topics=tuple(faster)))
    assert stage.screen.table.chosen_row.hz == 10.0  # type: ignore[union-attr]
    await stage.show(lesson_update(time_s=NOW_S + 0.2, topics=tuple(faster)))
    assert stage.screen.table.chosen_row.hz == 99.0  # type: ignore[union-attr]
    for key in ("p", "I", "i"):
        await stage.pilot.press(key)
        await stage.pilot.pause()
        assert stage.graph.period_s == 0.25, key
        await stage.pilot.press(key)
        await stage.pilot.pause()
        assert stage.graph.period_s == 0.1, key
    await stage.choose(SONAR)
    assert stage.graph.period_s == 0.25

"""Pictures: what the mock camera draws, and what the vision stub takes for a picture."""

from __future__ import annotations

from array import array
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from nodes.parts.pictures import BadPictureError, bgr
from nodes.simulated.scene import MovingScene


def message(**changes: Any) -> Any:
    fields = {"encoding": "bgr8", "width": 2, "height": 2, "step": 6, "data": array("B", range(12))}
    return SimpleNamespace(**{**fields, **changes})


def test_bgr_comes_as_it_is_and_rgb_is_turned() -> None:
    assert bgr(message())[0, 0].tolist() == [0, 1, 2]
    assert bgr(message(encoding="rgb8"))[0, 0].tolist() == [2, 1, 0]


def test_rows_may_be_padded() -> None:
    padded = message(step=8, data=array("B", range(16)))
    assert bgr(padded)[1, 0].tolist() == [8, 9, 10]


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"encoding": "mono8"}, "mono8"),
        ({"encoding": ""}, '""'),
        ({"width": 0}, "0x2"),
        ({"height": 0}, "2x0"),
        ({"step": 5}, "5 bytes a row"),
        ({"data": array("B", range(11))}, "11 bytes"),
        ({"width": 2**31}, "do not fit"),
    ],
)
def test_what_is_no_picture_is_refused_with_a_reason(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(BadPictureError, match=words):
        bgr(message(**changes))


def draw(number: int, *, blue_first: bool = False) -> np.ndarray[Any, np.dtype[np.uint8]]:
    picture = np.zeros((480, 640, 3), np.uint8)
    MovingScene(480, 640, blue_first=blue_first).draw(picture, number)
    return picture


def test_the_film_moves_and_can_be_repeated() -> None:
    assert (draw(7) == draw(7)).all()
    assert (draw(7) != draw(8)).any()


def test_the_sky_is_blue_in_both_orders_of_colours() -> None:
    red, _green, blue = draw(0)[2, 320].tolist()
    assert blue > red
    assert (draw(0, blue_first=True) == draw(0)[:, :, ::-1]).all()


def test_the_caption_counts() -> None:
    changed = (draw(100) != draw(101)).any(axis=2)
    caption = changed[40:70, 26:]
    assert caption.any()


@pytest.mark.parametrize(("height", "width"), [(16, 16), (16, 4096), (48, 64), (1080, 1920)])
def test_every_size_can_be_drawn(height: int, width: int) -> None:
    picture = np.zeros((height, width, 3), np.uint8)
    scene = MovingScene(height, width, blue_first=True)
    for number in (0, 9, 123_456_789):
        scene.draw(picture, number)
    assert picture.any()

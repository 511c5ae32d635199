"""YUV 4:2:2 and Bayer as pictures: which channel is red, odd sizes, short data."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest

from graph.data import Value
from graph.pictures.images import to_rgb
from graph.pictures.picture import IMAGE
from graph.pictures.pixels import ImageError
from graph.pictures.reading import read_picture

PATTERNS = ("rggb", "bggr", "gbrg", "grbg")
RED_Y, RED_U, RED_V = 81, 90, 240
"""Pure red (source: ITU-R BT.601, 8 bits, 16 to 235)."""


def image(
    encoding: str, width: int, height: int, data: bytes, step: int = 0, **others: Value
) -> dict[str, Value]:
    return {
        "height": height,
        "width": width,
        "encoding": encoding,
        "is_bigendian": 0,
        "step": step or len(data) // height,
        "data": data,
        **others,
    }


def mosaic(pattern: str, colours: dict[str, int], width: int, height: int, kind: str = "u1") -> Any:
    """What a sensor behind this pattern gives of a wall of one colour."""
    cells = [[colours[pattern[0]], colours[pattern[1]]], [colours[pattern[2]], colours[pattern[3]]]]
    return np.tile(np.array(cells, kind), (height, width))[:height, :width]


def all_of(rgb: Any) -> set[tuple[int, ...]]:
    return {tuple(pixel) for pixel in rgb.reshape(-1, 3).tolist()}


@pytest.mark.parametrize(
    ("encoding", "pair"),
    [
        ("uyvy", (RED_U, RED_Y, RED_V, RED_Y)),
        ("yuv422", (RED_U, RED_Y, RED_V, RED_Y)),
        ("yuyv", (RED_Y, RED_U, RED_Y, RED_V)),
        ("yuv422_yuy2", (RED_Y, RED_U, RED_Y, RED_V)),
    ],
)
@pytest.mark.parametrize("width", [4, 5, 3])
def test_red_is_red_in_every_order_of_yuv_and_at_odd_widths(
    encoding: str, pair: tuple[int, ...], width: int
) -> None:
    row = (bytes(pair) * 3)[: 2 * width]
    rgb = to_rgb(image(encoding, width, 2, (row + b"PAD") * 2))
    assert rgb.shape == (2, width, 3)
    assert np.abs(rgb.astype(int) - (255, 0, 0)).max() <= 3


def test_light_alone_is_grey_and_each_pixel_has_its_own() -> None:
    row = bytes((128, 16, 128, 235, 128, 235, 128, 16))
    assert to_rgb(image("uyvy", 4, 1, row)).tolist() == [
        [[0] * 3, [255] * 3, [255] * 3, [0] * 3],
    ]
    assert to_rgb(image("yuyv", 1, 1, bytes((235, 128)))).tolist() == [[[255] * 3]]


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize(("width", "height"), [(4, 4), (5, 3), (2, 2), (7, 2)])
def test_every_bayer_pattern_gives_the_colour_of_the_wall(
    pattern: str, width: int, height: int
) -> None:
    wall = mosaic(pattern, {"r": 250, "g": 120, "b": 10}, width, height)
    rgb = to_rgb(image(f"bayer_{pattern}8", width, height, wall.tobytes()))
    assert rgb.shape == (height, width, 3)
    assert all_of(rgb) == {(250, 120, 10)}


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize(("big", "kind"), [(0, "<u2"), (1, ">u2")])
def test_sixteen_bits_are_read_in_either_order_and_the_greatest_is_full_light(
    pattern: str, big: int, kind: str
) -> None:
    wall = mosaic(pattern, {"r": 4000, "g": 2000, "b": 0}, 6, 5, kind)
    rgb = to_rgb(image(f"bayer_{pattern}16", 6, 5, wall.tobytes(), is_bigendian=big))
    assert all_of(rgb) == {(255, 127, 0)}


@pytest.mark.parametrize("encoding", ["uyvy", "bayer_rggb8", "bayer_grbg16"])
def test_the_screen_of_topics_takes_no_more_pixels_than_it_shows(encoding: str) -> None:
    pixels = np.full((72, 128, 1 if encoding == "bayer_rggb8" else 2), 99, np.uint8)
    value = image(encoding, 128, 72, pixels.tobytes())
    picture = read_picture(IMAGE, value, lambda _wide, _high: (8, 4))
    assert picture.rgb.shape == (4, 8, 3)
    assert (picture.width, picture.height, picture.encoding) == (128, 72, encoding)


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (image("uyvy", 4, 2, bytes(15), 8), "2 rows of 8 bytes take 16, there are 15"),
        (image("yuyv", 4, 1, bytes(8), 7), "4 pixels of 2 bytes take 8"),
        (image("bayer_rggb8", 4, 4, bytes(15), 4), "4 rows of 4 bytes take 16, there are 15"),
        (image("bayer_rggb16", 4, 1, bytes(8), 4), "4 pixels of 2 bytes take 8"),
        (image("bayer_bggr8", 0, 1, bytes(8)), "the picture is empty: 0 x 1"),
    ],
)
def test_short_data_are_refused_in_words(value: dict[str, Value], words: str) -> None:
    with pytest.raises(ImageError, match=words):
        to_rgb(value)


@pytest.mark.parametrize("encoding", ["uyvy", "bayer_rggb8"])
def test_without_opencv_a_word_says_so(encoding: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cv2", None)
    with pytest.raises(ImageError, match="OpenCV, which decodes them, is missing"):
        to_rgb(image(encoding, 2, 2, bytes(8), 4))

"""Pictures from camera messages: the right colours, whatever the layout; a word when it is none."""

from __future__ import annotations

import numpy as np
import pytest

from graph.data import Value
from graph.pictures.images import shrink, to_rgb
from graph.pictures.pixels import ImageError

ORANGE = (250, 120, 10)


def message(encoding: str, rows: list[bytes], width: int, **others: Value) -> dict[str, Value]:
    return {
        "header": {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": "camera_link"},
        "height": len(rows),
        "width": width,
        "encoding": encoding,
        "is_bigendian": 0,
        "step": len(rows[0]) if rows else 0,
        "data": b"".join(rows),
        **others,
    }


@pytest.mark.parametrize(
    ("encoding", "pixel"),
    [
        ("rgb8", bytes(ORANGE)),
        ("bgr8", bytes(reversed(ORANGE))),
        ("8UC3", bytes(reversed(ORANGE))),
        ("rgba8", bytes((*ORANGE, 255))),
        ("bgra8", bytes((*reversed(ORANGE), 255))),
    ],
)
def test_colours_are_right_in_every_order_and_with_padded_rows(encoding: str, pixel: bytes) -> None:
    black = bytes(len(pixel))
    rgb = to_rgb(message(encoding, [pixel + black + b"PAD", black + pixel + b"PAD"], 2))
    assert rgb.tolist() == [[list(ORANGE), [0, 0, 0]], [[0, 0, 0], list(ORANGE)]]
    assert rgb.dtype == np.uint8


def test_grey_is_equal_in_all_channels() -> None:
    assert to_rgb(message("mono8", [bytes([0, 128, 255])], 3)).tolist() == [
        [[0] * 3, [128] * 3, [255] * 3]
    ]


@pytest.mark.parametrize(("big", "order"), [(0, "<u2"), (1, ">u2")])
def test_depth_goes_from_black_to_white_in_either_byte_order(big: int, order: str) -> None:
    row = np.array([500, 1500, 2500], order).tobytes()
    rgb = to_rgb(message("16UC1", [row + b"odd"], 3, is_bigendian=big))
    assert rgb[0, :, 0].tolist() == [0, 127, 255]


def test_depth_without_a_valid_reading_is_black_there() -> None:
    row = np.array([np.nan, 1.0, np.inf, 3.0, -3.0e38, 3.0e38], "<f4").tobytes()
    rgb = to_rgb(message("32FC1", [row], 6))
    assert rgb[0, :, 0].tolist() == [0, 127, 0, 127, 0, 255]
    nothing = np.full(2, np.nan, "<f4").tobytes()
    assert not to_rgb(message("32FC1", [nothing], 2)).any()


@pytest.mark.parametrize(
    ("broken", "word"),
    [
        ({"encoding": "nv21"}, "encoding 'nv21' is not supported; supported: rgb8"),
        ({"step": 5}, "step 5 is too small: 2 pixels of 3 bytes take 6"),
        ({"height": 3}, "3 rows of 6 bytes take 18, there are 12"),
        ({"height": 0}, "the picture is empty: 2 x 0"),
        ({"width": 0}, "the picture is empty: 0 x 2"),
        ({"data": "text"}, "not a sensor_msgs/Image"),
        ({"width": None}, "width is missing"),
    ],
)
def test_what_is_no_picture_is_refused_in_words(broken: dict[str, Value], word: str) -> None:
    value = {**message("rgb8", [bytes(6), bytes(6)], 2), **broken}
    with pytest.raises(ImageError, match=word.replace("(", r"\(")):
        to_rgb(value)


def test_shrinking_keeps_places_and_means() -> None:
    rgb = np.zeros((480, 640, 3), np.uint8)
    rgb[:240, :320] = ORANGE
    rgb[240:, 320:] = [[200] * 3, [100] * 3] * 160
    small = shrink(rgb, 80, 48)
    assert small.shape == (48, 80, 3)
    assert small[0, 0].tolist() == list(ORANGE)
    assert small[0, 79].tolist() == [0, 0, 0]
    assert small[47, 0].tolist() == [0, 0, 0]
    assert 100 <= int(small[40, 60, 0]) <= 200


@pytest.mark.parametrize(("width", "height"), [(1, 1), (7, 5), (40, 30)])
def test_any_size_can_be_had_of_any_picture(width: int, height: int) -> None:
    rgb = np.full((3, 4, 3), 77, np.uint8)
    small = shrink(rgb, width, height)
    assert small.shape == (height, width, 3)
    assert (small == 77).all()

"""Pictures of every layout at the size that is shown: colours, depth, JPEG, and refusals."""

from __future__ import annotations

import struct
from typing import Any

import cv2
import numpy as np
import pytest

from graph.data import Value
from graph.heavy_types import COMPRESSED_IMAGE, IMAGE
from graph.pictures.compressed import thinned_picture
from graph.pictures.pixels import ImageError, to_rgb
from graph.pictures.reading import read_picture

ORANGE = (250, 120, 10)


def whole(width: int, height: int) -> tuple[int, int]:
    return width, height


def small(_width: int, _height: int) -> tuple[int, int]:
    return 8, 4


def image(pixels: Any, encoding: str, **others: Value) -> dict[str, Value]:
    return {
        "height": pixels.shape[0],
        "width": pixels.shape[1],
        "encoding": encoding,
        "is_bigendian": 0,
        "step": pixels[0].nbytes,
        "data": pixels.tobytes(),
        **others,
    }


def compressed(pixels: Any, ending: str = ".jpg", words: str = "") -> dict[str, Value]:
    done, data = cv2.imencode(ending, pixels)
    assert done
    return {"format": words or ending[1:], "data": data.tobytes()}


@pytest.mark.parametrize(("encoding", "kind", "unit"), [("16UC1", "u2", 1000), ("32FC1", "f4", 1)])
@pytest.mark.parametrize(("big", "order"), [(0, "<"), (1, ">")])
def test_depth_is_told_in_metres_and_near_is_bright(
    encoding: str, kind: str, unit: int, big: int, order: str
) -> None:
    row = np.linspace(0.52, 3.97, 100) * unit
    numbers = np.repeat(row[None, :], 10, axis=0).astype(order + kind)
    numbers[0, :] = 0
    picture = read_picture(IMAGE, image(numbers, encoding, is_bigendian=big), whole)
    assert picture.range_m == (0.5, 4.0)
    assert not picture.rgb[0].any()
    light = picture.rgb[5].astype(int).sum(axis=1)
    assert (np.diff(light) <= 0).sum() > 90
    assert light[0] > 2 * light[-1]


@pytest.mark.parametrize(("ending", "encoding"), [(".jpg", "jpeg"), (".png", "png")])
def test_compressed_pictures_have_their_colours_and_size(ending: str, encoding: str) -> None:
    pixels = np.full((720, 1280, 3), ORANGE[::-1], np.uint8)
    picture = read_picture(COMPRESSED_IMAGE, compressed(pixels, ending), small)
    assert (picture.width, picture.height, picture.encoding) == (1280, 720, encoding)
    assert picture.rgb.shape == (4, 8, 3)
    assert np.abs(picture.rgb.astype(int) - ORANGE).max() <= 3


@pytest.mark.parametrize(("encoding", "unit"), [("16UC1", 1000), ("32FC1", 1.0)])
def test_thinned_depth_stays_depth(encoding: str, unit: float) -> None:
    kind = np.uint16 if encoding == "16UC1" else np.float32
    metres = np.full((480, 640), 2.0)
    metres[:, 320:] = 4.0
    words, data = thinned_picture(image((metres * unit).astype(kind), encoding))
    picture = read_picture(COMPRESSED_IMAGE, {"format": words, "data": data}, whole)
    assert picture.range_m == pytest.approx((2.0, 4.0), abs=0.1)


def bomb(width: int, height: int) -> bytes:
    head = b"IHDR" + struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 13) + head + bytes(4) + b"IEND\xaeB`\x82"


NOISE = np.random.default_rng(1).integers(0, 255, (64, 64, 3), np.uint8)
JPEG_BYTES = bytes(compressed(NOISE)["data"])  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ({"format": "jpeg", "data": b""}, "the message has no data"),
        ({"format": "jpeg", "data": b"GIF89a.."}, "neither JPEG nor PNG: they begin with 47 49"),
        ({"format": "jpeg", "data": JPEG_BYTES[:-2000]}, "JPEG data are cut short: no end in"),
        ({"format": "jpeg", "data": b"\xff\xd8\xff\xe0\0\2"}, "do not say how large"),
        ({"format": "jpeg", "data": b"\xff\xd8\xff" + b"\0" * 500}, "do not say how large"),
        ({"format": "png", "data": bomb(100_000, 100_000)}, "100000 x 100000 is not decoded"),
        ({"format": "png", "data": bomb(0, 5)}, "0 x 5 is not decoded"),
        ({"format": "png", "data": bomb(8, 8)}, "PNG data are damaged"),
        ({"format": "png", "data": b"\x89PNG\r\n\x1a\n"}, "PNG data are cut short"),
        ({"format": 5, "data": b""}, "not a sensor_msgs/CompressedImage"),
        ({"format": "jpeg"}, "not a sensor_msgs/CompressedImage"),
    ],
)
def test_what_cannot_be_decoded_is_named(value: dict[str, Value], words: str) -> None:
    with pytest.raises(ImageError, match=words):
        read_picture(COMPRESSED_IMAGE, value, whole)


def test_too_many_bytes_are_not_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("graph.pictures.compressed.MOST_BYTES", 100)
    with pytest.raises(ImageError, match="too large"):
        read_picture(COMPRESSED_IMAGE, {"format": "jpeg", "data": JPEG_BYTES}, whole)


def test_no_damage_ends_in_anything_but_a_word() -> None:
    random = np.random.default_rng(7)
    for _round in range(200):
        data = bytearray(JPEG_BYTES)
        for place in random.integers(2, len(data) - 2, 20):
            data[place] = random.integers(0, 256)
        try:
            picture = read_picture(COMPRESSED_IMAGE, {"format": "jpeg", "data": bytes(data)}, small)
        except ImageError:
            continue
        assert picture.rgb.size


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


PATTERNS = ("rggb", "bggr", "gbrg", "grbg")
RED_Y, RED_U, RED_V = 81, 90, 240
"""Pure red (source: ITU-R BT.601, 8 bits, 16 to 235)."""


def image_raw_colours(
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
def test_red_is_red_in_every_order_of_yuv_and_at_odd_widths(encoding: str, pair: tuple[int, ...], width: int) -> None:
    row = (bytes(pair) * 3)[: 2 * width]
    rgb = to_rgb(image_raw_colours(encoding, width, 2, (row + b"PAD") * 2))
    assert rgb.shape == (2, width, 3)
    assert np.abs(rgb.astype(int) - (255, 0, 0)).max() <= 3


@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize(("width", "height"), [(4, 4), (5, 3), (2, 2), (7, 2)])
def test_every_bayer_pattern_gives_the_colour_of_the_wall(pattern: str, width: int, height: int) -> None:
    wall = mosaic(pattern, {"r": 250, "g": 120, "b": 10}, width, height)
    rgb = to_rgb(image_raw_colours(f"bayer_{pattern}8", width, height, wall.tobytes()))
    assert rgb.shape == (height, width, 3)
    assert all_of(rgb) == {(250, 120, 10)}


HERE, ELSEWHERE = b"\x01\x0f\x11\x22", b"\x01\x0f\x33\x44"

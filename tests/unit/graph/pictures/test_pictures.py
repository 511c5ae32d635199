"""Pictures at the size that is shown: colours, depth with its range, JPEG and PNG, and refusals."""

from __future__ import annotations

import struct
import sys
from typing import Any

import cv2
import numpy as np
import pytest

from graph.data import Value
from graph.pictures.picture import COMPRESSED, IMAGE, RAMP, ramp_colours, rounded
from graph.pictures.pixels import ImageError
from graph.pictures.reading import read_picture
from graph.pictures.thinning import thinned_picture

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


@pytest.mark.parametrize(
    ("encoding", "pixel", "shown"),
    [
        ("rgb8", ORANGE, ORANGE),
        ("bgr8", ORANGE[::-1], ORANGE),
        ("rgba8", (*ORANGE, 255), ORANGE),
        ("bgra8", (*ORANGE[::-1], 255), ORANGE),
        ("mono8", (77,), (77, 77, 77)),
    ],
)
def test_colours_are_right_and_only_what_is_shown_is_taken(
    encoding: str, pixel: tuple[int, ...], shown: tuple[int, ...]
) -> None:
    pixels = np.full((72, 128, len(pixel)), pixel, np.uint8)
    picture = read_picture(IMAGE, image(pixels, encoding), small)
    assert picture.rgb.shape == (4, 8, 3)
    assert (picture.rgb == shown).all()
    assert (picture.width, picture.height, picture.encoding) == (128, 72, encoding)
    assert picture.range_m is None


def test_a_picture_that_is_smaller_than_wanted_stays_as_it_is() -> None:
    pixels = np.arange(12, dtype=np.uint8).reshape(2, 2, 3)
    assert (read_picture(IMAGE, image(pixels, "rgb8"), small).rgb == pixels).all()


def test_thinning_keeps_places() -> None:
    pixels = np.zeros((80, 160, 3), np.uint8)
    pixels[:40, :80] = ORANGE
    rgb = read_picture(IMAGE, image(pixels, "rgb8"), small).rgb
    assert (rgb[:2, :4] == ORANGE).all()
    assert not rgb[2:].any()
    assert not rgb[:, 4:].any()


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


def test_depth_without_a_reading_is_black_and_has_no_range() -> None:
    numbers = np.array([[np.nan, np.inf, 0.0, -1.0]], "<f4")
    picture = read_picture(IMAGE, image(numbers, "32FC1"), whole)
    assert picture.range_m is None
    assert not picture.rgb.any()


@pytest.mark.parametrize("shape", [IMAGE, COMPRESSED])
def test_a_distance_between_the_pixels_that_are_shown_is_one(shape: str) -> None:
    numbers = np.zeros((80, 160), np.uint16)
    assert read_picture(IMAGE, image(numbers, "16UC1"), small).is_empty_depth
    numbers[1, 1] = 1500
    value = image(numbers, "16UC1")
    if shape == COMPRESSED:
        value = compressed(numbers, ".png", "16UC1; compressedDepth png")
        value["data"] = struct.pack("<iff", 0, 0.0, 0.0) + value["data"]  # type: ignore[operator]
    picture = read_picture(shape, value, small)
    assert not picture.rgb.any()
    assert not picture.is_empty_depth


def test_one_stray_reading_does_not_take_all_colours() -> None:
    numbers = np.full((100, 100), 1500, "<u2")
    numbers[:50] = 1000
    numbers[0, 0] = 65_535
    assert read_picture(IMAGE, image(numbers, "16UC1"), whole).range_m == (1.0, 1.5)


@pytest.mark.parametrize(
    ("near", "far", "shown"),
    [(0.52, 3.97, (0.5, 4.0)), (2.0, 2.0, (2.0, 2.005)), (0.001, 65.5, (0.0, 70.0))],
)
def test_ranges_are_round(near: float, far: float, shown: tuple[float, float]) -> None:
    assert rounded(near, far) == pytest.approx(shown)


def test_the_ramp_goes_from_bright_to_dark() -> None:
    ramp = ramp_colours(16).astype(float) @ (0.2126, 0.7152, 0.0722)
    assert (np.diff(ramp) < 0).all()
    assert ramp_colours(2).tolist() == [list(RAMP[0]), list(RAMP[-1])]


@pytest.mark.parametrize(("ending", "encoding"), [(".jpg", "jpeg"), (".png", "png")])
def test_compressed_pictures_have_their_colours_and_size(ending: str, encoding: str) -> None:
    pixels = np.full((720, 1280, 3), ORANGE[::-1], np.uint8)
    picture = read_picture(COMPRESSED, compressed(pixels, ending), small)
    assert (picture.width, picture.height, picture.encoding) == (1280, 720, encoding)
    assert picture.rgb.shape == (4, 8, 3)
    assert np.abs(picture.rgb.astype(int) - ORANGE).max() <= 3


@pytest.mark.parametrize("encoding", ["rgb8", "mono8"])
def test_a_thinned_picture_is_small_and_tells_the_size_of_the_camera(encoding: str) -> None:
    shape = (720, 1280, 3) if encoding == "rgb8" else (720, 1280)
    words, data = thinned_picture(image(np.full(shape, 90, np.uint8), encoding))
    assert len(data) < 10_000
    picture = read_picture(COMPRESSED, {"format": words, "data": data}, whole)
    assert (picture.width, picture.height) == (1280, 720)
    assert picture.rgb.shape == (225, 400, 3)
    assert (abs(picture.rgb.astype(int) - 90) < 3).all()


@pytest.mark.parametrize(("encoding", "unit"), [("16UC1", 1000), ("32FC1", 1.0)])
def test_thinned_depth_stays_depth(encoding: str, unit: float) -> None:
    kind = np.uint16 if encoding == "16UC1" else np.float32
    metres = np.full((480, 640), 2.0)
    metres[:, 320:] = 4.0
    words, data = thinned_picture(image((metres * unit).astype(kind), encoding))
    picture = read_picture(COMPRESSED, {"format": words, "data": data}, whole)
    assert picture.range_m == pytest.approx((2.0, 4.0), abs=0.1)


def test_what_is_no_picture_is_not_thinned() -> None:
    with pytest.raises(ImageError):
        thinned_picture({"width": 4, "height": 4, "step": 12, "encoding": "rgb8", "data": b""})


def test_compressed_grey_is_grey() -> None:
    picture = read_picture(COMPRESSED, compressed(np.full((8, 8), 77, np.uint8), ".png"), whole)
    assert (picture.rgb == 77).all()


def test_compressed_depth_is_depth() -> None:
    numbers = np.full((20, 20), 1500, np.uint16)
    numbers[:10] = 1000
    value = compressed(numbers, ".png", "16UC1; compressedDepth png")
    value["data"] = struct.pack("<iff", 0, 0.0, 0.0) + value["data"]  # type: ignore[operator]
    picture = read_picture(COMPRESSED, value, whole)
    assert (picture.encoding, picture.range_m) == ("16UC1", (1.0, 1.5))


def test_compressed_inverse_depth_is_depth() -> None:
    numbers = np.full((20, 20), 200, np.uint16)
    numbers[:10] = 100
    value = compressed(numbers, ".png", "32FC1; compressedDepth png")
    value["data"] = struct.pack("<iff", 1, 200.0, 0.0) + value["data"]  # type: ignore[operator]
    assert read_picture(COMPRESSED, value, whole).range_m == (1.0, 2.0)


def bomb(width: int, height: int) -> bytes:
    """Return a PNG that asks for this many pixels and has none."""
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
        read_picture(COMPRESSED, value, whole)


def test_too_many_bytes_are_not_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("graph.pictures.compressed.MOST_BYTES", 100)
    with pytest.raises(ImageError, match="too large"):
        read_picture(COMPRESSED, {"format": "jpeg", "data": JPEG_BYTES}, whole)


def test_without_opencv_a_word_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cv2", None)
    with pytest.raises(ImageError, match="OpenCV, which decodes them, is missing"):
        read_picture(COMPRESSED, {"format": "jpeg", "data": JPEG_BYTES}, whole)


def test_no_damage_ends_in_anything_but_a_word() -> None:
    random = np.random.default_rng(7)
    for _round in range(200):
        data = bytearray(JPEG_BYTES)
        for place in random.integers(2, len(data) - 2, 20):
            data[place] = random.integers(0, 256)
        try:
            picture = read_picture(COMPRESSED, {"format": "jpeg", "data": bytes(data)}, small)
        except ImageError:
            continue
        assert picture.rgb.size

"""The pixels of a `sensor_msgs/Image`: its encodings, its rows, and what can be wrong with them.

numpy is imported in the functions: widgets import this room before there is any picture.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Mapping
    from types import ModuleType

    import numpy as np
    from numpy.typing import NDArray

    from graph.data import Value
    from text.sentences import Words

    Rgb: TypeAlias = NDArray[np.uint8]
    """Shape (height, width, 3)."""

COLOURS = {
    "rgb8": (3, (0, 1, 2)),
    "bgr8": (3, (2, 1, 0)),
    "8UC3": (3, (2, 1, 0)),
    "rgba8": (4, (0, 1, 2)),
    "bgra8": (4, (2, 1, 0)),
    "8UC4": (4, (2, 1, 0)),
    "mono8": (1, (0, 0, 0)),
    "8UC1": (1, (0, 0, 0)),
}
"""Bytes per pixel, and which of them are red, green and blue."""
DEPTHS = {"mono16": "u2", "16UC1": "u2", "32FC1": "f4"}
"""Numbers with no colour of their own: shown from black, the least, to white, the greatest."""
YUV = {"uyvy": "UYVY", "yuv422": "UYVY", "yuyv": "YUY2", "yuv422_yuy2": "YUY2"}
"""Encodings in which two pixels share U and V, to OpenCV's name of the order (`yuv422` is the old
name of `uyvy`)."""
BAYER = {
    f"bayer_{pattern}{bits}": (pattern.upper(), bits // 8)
    for bits in (8, 16)
    for pattern in ("rggb", "bggr", "gbrg", "grbg")
}
"""One colour per pixel: the pattern by rows from the top left, and the bytes per pixel."""


class ImageError(ValueError):
    """The message is not a picture that can be shown; `words` says why."""

    def __init__(self, words: Words) -> None:
        super().__init__(words)
        self.words = words


class UnknownEncodingError(ImageError):
    """The pixels may be valid, but their encoding is not supported."""

    def __init__(self, encoding: str) -> None:
        known = ", ".join([*COLOURS, *DEPTHS, *YUV, *BAYER])
        super().__init__(
            say("encoding '{encoding}' is not supported; supported: {known}", encoding=encoding, known=known)
        )


def image_fields(value: Mapping[str, Value]) -> tuple[tuple[int, int, int], str, bytes | bytearray | memoryview]:
    """Return (width, height, step), encoding and data of a `sensor_msgs/Image`.

    Raises ImageError.
    """
    size = (_whole(value, "width"), _whole(value, "height"), _whole(value, "step"))
    encoding, data = value.get("encoding"), value.get("data")
    if not isinstance(encoding, str) or not isinstance(data, (bytes, bytearray, memoryview)):
        raise ImageError(say("this is not a {type}", type="sensor_msgs/Image"))
    return size, encoding, data


def _whole(value: Mapping[str, Value], name: str) -> int:
    number = value.get(name)
    if not isinstance(number, int):
        words = say("this is not a {type}: {name} is missing", type="sensor_msgs/Image", name=name)
        raise ImageError(words)
    return number


def pixel_rows(data: bytes | bytearray | memoryview, width: int, height: int, step: int, pixel_bytes: int) -> Rgb:
    """Return the bytes of the pixels, shape (height, width * pixel_bytes), without padding."""
    import numpy as np

    if width < 1 or height < 1:
        words = say("the picture is empty: {width} x {height}", width=width, height=height)
        raise ImageError(words)
    if step < width * pixel_bytes:
        raise ImageError(
            say(
                "step {step} is too small: {width} pixels of {size} bytes take {total}",
                step=step,
                width=width,
                size=pixel_bytes,
                total=width * pixel_bytes,
            )
        )
    if len(data) < height * step:
        raise ImageError(
            say(
                "the data are too short: {height} rows of {step} bytes take {total}, there are {found}",
                height=height,
                step=step,
                total=height * step,
                found=len(data),
            )
        )
    rows = np.frombuffer(data, np.uint8, height * step).reshape(height, step)
    return rows[:, : width * pixel_bytes]


def in_order(pixels: Rgb, order: tuple[int, ...]) -> Rgb:
    """Return pixels of shape (height, width, bytes) reordered to red, green and blue."""
    if order == (2, 1, 0):
        return pixels[:, :, 2::-1]
    if order == (0, 1, 2):
        return pixels[:, :, :3]
    return pixels.repeat(3, axis=2)


def grey(numbers: NDArray[np.generic]) -> Rgb:
    """Return grey from the least to the greatest finite number; non-finite numbers are black."""
    import numpy as np

    values = numbers.astype(np.float64)
    finite = np.isfinite(values)
    if not finite.any():
        return np.zeros((*values.shape, 3), np.uint8)
    least, greatest = float(values[finite].min()), float(values[finite].max())
    span = (greatest - least) or 1.0
    grey = np.where(finite, (values - least) * (255.0 / span), 0.0).astype(np.uint8)
    return np.repeat(grey[:, :, None], 3, axis=2)


def opencv() -> ModuleType:
    """Return OpenCV, imported when the first picture needs it; raises ImageError."""
    try:
        import cv2
    except ImportError as error:
        words = say("OpenCV, which decodes them, is missing: {error}", error=error)
        raise ImageError(words) from error
    return cv2

"""The pixels of a `sensor_msgs/Image`: its encodings, its rows, its colours, and what can be wrong with them.

numpy and OpenCV are imported in the functions: widgets import this room before there is any picture. Source of the
names: sensor_msgs/image_encodings.hpp.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

from text.sentences import say

if TYPE_CHECKING:
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
NO_COLOUR = 128
"""The U and V value of grey."""
BORDER = 2
"""Pixels added around a Bayer picture: OpenCV leaves a picture without interior black."""


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
    size = []
    for name in ("width", "height", "step"):
        number = value.get(name)
        if not isinstance(number, int):
            words = say("this is not a {type}: {name} is missing", type="sensor_msgs/Image", name=name)
            raise ImageError(words)
        size.append(number)
    encoding, data = value.get("encoding"), value.get("data")
    if not isinstance(encoding, str) or not isinstance(data, (bytes, bytearray, memoryview)):
        raise ImageError(say("this is not a {type}", type="sensor_msgs/Image"))
    return (size[0], size[1], size[2]), encoding, data


def pixels_of(value: Mapping[str, Value]) -> NDArray[Any]:
    """Return the pixels of a `sensor_msgs/Image`, not copied if avoidable; raises ImageError.

    Their shape is (height, width, n): the bytes of an encoding of `COLOURS` in its order, one number for one of
    `DEPTHS`, red, green and blue for the others.
    """
    (width, height, step), encoding, data = image_fields(value)
    order = ">" if value.get("is_bigendian") else "<"
    if encoding in COLOURS:
        count = COLOURS[encoding][0]
        return pixel_rows(data, width, height, step, count).reshape(height, width, count)
    if encoding in DEPTHS:
        kind = order + DEPTHS[encoding]
        return pixel_rows(data, width, height, step, int(kind[-1])).copy().view(kind)[:, :, None]
    if encoding in YUV:
        return _yuv(YUV[encoding], pixel_rows(data, width, height, step, 2).reshape(height, width, 2))
    if encoding in BAYER:
        pattern, size = BAYER[encoding]
        rows = pixel_rows(data, width, height, step, size)
        return _bayer(pattern, rows if size == 1 else rows.copy().view(f"{order}u2"))
    raise UnknownEncodingError(encoding)


def coloured(pixels: NDArray[Any], encoding: str) -> Rgb:
    """Return what `pixels_of` has found, or some of it, as red, green and blue."""
    if encoding in DEPTHS:
        return grey(pixels[:, :, 0])
    order = COLOURS[encoding][1] if encoding in COLOURS else (0, 1, 2)
    if order == (0, 0, 0):
        return pixels.repeat(3, axis=2)
    return pixels[:, :, 2::-1] if order == (2, 1, 0) else pixels[:, :, :3]


def to_rgb(value: Mapping[str, Value]) -> Rgb:
    """Return the picture of a `sensor_msgs/Image`; raises ImageError."""
    return coloured(pixels_of(value), str(value["encoding"]))


def pixel_rows(data: bytes | bytearray | memoryview, width: int, height: int, step: int, pixel_bytes: int) -> Rgb:
    """Return the bytes of the pixels, shape (height, width * pixel_bytes), without padding."""
    import numpy as np

    row = width * pixel_bytes
    if width < 1 or height < 1:
        raise ImageError(say("the picture is empty: {width} x {height}", width=width, height=height))
    if step < row:
        raise ImageError(
            say(
                "step {step} is too small: {width} pixels of {size} bytes take {total}",
                step=step,
                width=width,
                size=pixel_bytes,
                total=row,
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
    return np.frombuffer(data, np.uint8, height * step).reshape(height, step)[:, :row]


def grey(numbers: NDArray[np.generic]) -> Rgb:
    """Return grey from the least to the greatest finite number; non-finite numbers are black."""
    import numpy as np

    values = numbers.astype(np.float64)
    finite = np.isfinite(values)
    least, greatest = (values[finite].min(), values[finite].max()) if finite.any() else (0.0, 0.0)
    span = (greatest - least) or 1.0
    grey = np.where(finite, (values - least) * (255.0 / span), 0.0).astype(np.uint8)
    return np.repeat(grey[:, :, None], 3, axis=2)


def shrink(rgb: Rgb, width: int, height: int) -> Rgb:
    """Return the picture at this size in pixels, each the mean of four samples of its area.

    Four samples instead of all take a thirtieth of the time, and a terminal shows no difference.
    """
    import numpy as np

    rows = (np.arange(2 * height) * rgb.shape[0] + rgb.shape[0] // 2) // (2 * height)
    columns = (np.arange(2 * width) * rgb.shape[1] + rgb.shape[1] // 2) // (2 * width)
    samples = rgb[rows[:, None], columns].astype(np.uint16)
    total = samples[::2, ::2] + samples[1::2, ::2] + samples[::2, 1::2] + samples[1::2, 1::2]
    mean: Rgb = (total >> 2).astype(np.uint8)
    return mean


def opencv() -> ModuleType:
    """Return OpenCV, imported when the first picture needs it; raises ImageError."""
    try:
        import cv2
    except ImportError as error:
        words = say("OpenCV, which decodes them, is missing: {error}", error=error)
        raise ImageError(words) from error
    return cv2


def _yuv(order: str, pairs: NDArray[np.uint8]) -> Rgb:
    """Return pairs of shape (height, width, 2) in colours.

    A row that ends within a pair takes the second half of its last colour from the pair before.
    """
    import numpy as np

    cv2 = opencv()
    height, width, _bytes = pairs.shape
    if width % 2:
        before = pairs[:, -2:-1] if width > 1 else np.full((height, 1, 2), NO_COLOUR, np.uint8)
        pairs = np.concatenate([pairs, before], axis=1)
    rgb: Rgb = cv2.cvtColor(pairs, getattr(cv2, f"COLOR_YUV2RGB_{order}"))
    return rgb[:, :width]


def _bayer(pattern: str, numbers: NDArray[Any]) -> Rgb:
    """Return numbers of shape (height, width) in three colours, each the mean of its neighbours.

    Of 16 bits the greatest number is full brightness: most cameras send 10 or 12 of them.
    """
    import numpy as np

    cv2 = opencv()
    # By an even number and mirrored, so that the pattern continues.
    wider = np.pad(numbers.astype(numbers.dtype.newbyteorder("=")), BORDER, "reflect")
    colours: NDArray[Any] = cv2.cvtColor(wider, getattr(cv2, f"COLOR_Bayer{pattern}2RGB"))
    colours = colours[BORDER:-BORDER, BORDER:-BORDER]
    if colours.dtype == np.uint8:
        return colours
    rgb: Rgb = (colours.astype(np.uint32) * 255 // max(1, int(colours.max()))).astype(np.uint8)
    return rgb

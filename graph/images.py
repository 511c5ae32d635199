"""Camera messages as pictures: `sensor_msgs/Image` as a tree to RGB, with numpy alone.

numpy is imported in the functions: widgets import this room before there is any picture.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from graph.data import Value

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
"""Bytes of a pixel, and which of them are red, green and blue."""
DEPTHS = {"mono16": "u2", "16UC1": "u2", "32FC1": "f4"}
"""Numbers with no colour of their own: shown from black, the least, to white, the greatest."""


class ImageError(ValueError):
    """The message is no picture that can be shown; str() says what is wrong with it."""


def to_rgb(value: Mapping[str, Value]) -> Rgb:
    """Return the picture of a `sensor_msgs/Image`; its pixels are not copied where that can be.

    Raises ImageError.
    """
    width, height, step = (whole(value, name) for name in ("width", "height", "step"))
    encoding, data = value.get("encoding"), value.get("data")
    if not isinstance(encoding, str) or not isinstance(data, (bytes, bytearray, memoryview)):
        raise ImageError("this is no sensor_msgs/Image")
    if encoding in COLOURS:
        pixel_bytes, order = COLOURS[encoding]
        pixels = pixel_rows(data, width, height, step, pixel_bytes)
        return in_order(pixels.reshape(height, width, pixel_bytes), order)
    if encoding in DEPTHS:
        kind = (">" if value.get("is_bigendian") else "<") + DEPTHS[encoding]
        rows = pixel_rows(data, width, height, step, int(kind[-1]))
        return grey(rows.copy().view(kind))
    known = ", ".join([*COLOURS, *DEPTHS])
    raise ImageError(f"encoding '{encoding}' is not shown; known are {known}")


def shrink(rgb: Rgb, width: int, height: int) -> Rgb:
    """Return the picture at this size in pixels, each the mean of four samples of its area.

    Four samples in place of all: a thirtieth of the time, and in a terminal nobody sees more.
    """
    import numpy as np

    rows = (np.arange(2 * height) * rgb.shape[0] + rgb.shape[0] // 2) // (2 * height)
    columns = (np.arange(2 * width) * rgb.shape[1] + rgb.shape[1] // 2) // (2 * width)
    samples = rgb[rows[:, None], columns].astype(np.uint16)
    total = samples[::2, ::2] + samples[1::2, ::2] + samples[::2, 1::2] + samples[1::2, 1::2]
    mean: Rgb = (total >> 2).astype(np.uint8)
    return mean


def whole(value: Mapping[str, Value], name: str) -> int:
    """Return a field that is a whole number; raises ImageError."""
    number = value.get(name)
    if not isinstance(number, int):
        raise ImageError(f"this is no sensor_msgs/Image: {name} is missing")
    return number


def pixel_rows(
    data: bytes | bytearray | memoryview, width: int, height: int, step: int, pixel_bytes: int
) -> Rgb:
    """Return the bytes of the pixels, shape (height, width * pixel_bytes), padding cut off."""
    import numpy as np

    if width < 1 or height < 1:
        raise ImageError(f"the picture is empty: {width} x {height}")
    if step < width * pixel_bytes:
        raise ImageError(
            f"step {step} is too small: {width} pixels of {pixel_bytes} bytes take "
            f"{width * pixel_bytes}"
        )
    if len(data) < height * step:
        raise ImageError(
            f"the data are too short: {height} rows of {step} bytes take {height * step}, "
            f"there are {len(data)}"
        )
    rows = np.frombuffer(data, np.uint8, height * step).reshape(height, step)
    return rows[:, : width * pixel_bytes]


def in_order(pixels: Rgb, order: tuple[int, ...]) -> Rgb:
    """Return pixels of shape (height, width, bytes) with red, green and blue in their places."""
    if order == (2, 1, 0):
        return pixels[:, :, 2::-1]
    if order == (0, 1, 2):
        return pixels[:, :, :3]
    return pixels.repeat(3, axis=2)


def grey(numbers: NDArray[np.generic]) -> Rgb:
    """Return grey from the least to the greatest finite number; what is not finite is black."""
    import numpy as np

    values = numbers.astype(np.float64)
    finite = np.isfinite(values)
    if not finite.any():
        return np.zeros((*values.shape, 3), np.uint8)
    least, greatest = float(values[finite].min()), float(values[finite].max())
    span = (greatest - least) or 1.0
    grey = np.where(finite, (values - least) * (255.0 / span), 0.0).astype(np.uint8)
    return np.repeat(grey[:, :, None], 3, axis=2)

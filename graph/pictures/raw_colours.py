"""Images in which a pixel does not carry its whole colour: YUV 4:2:2 and Bayer, by OpenCV.

Source of the names: sensor_msgs/image_encodings.hpp. OpenCV is imported in the functions, as numpy
is: few cameras need it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from graph.pictures.pixels import BAYER, YUV, opencv, pixel_rows

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from graph.pictures.pixels import Rgb

NO_COLOUR = 128
"""The U and V value of grey."""
BORDER = 2
"""Pixels added around a Bayer picture: OpenCV leaves a picture without interior black."""


def full_colours(
    encoding: str, data: bytes | bytearray | memoryview, size: tuple[int, int], step: int, *, big_endian: bool
) -> Rgb:
    """Return a picture of `YUV` or `BAYER`, given its width and height; raises ImageError."""
    width, height = size
    if encoding in YUV:
        return _yuv(YUV[encoding], _pairs(data, width, height, step))[:, :width]
    pattern, pixel_bytes = BAYER[encoding]
    rows = pixel_rows(data, width, height, step, pixel_bytes)
    if pixel_bytes == 1:
        return _bayer(pattern, rows)
    return _stretched(_bayer(pattern, rows.copy().view(">u2" if big_endian else "<u2")))


def _pairs(data: bytes | bytearray | memoryview, width: int, height: int, step: int) -> NDArray[np.uint8]:
    """Return bytes of shape (height, width, 2), one pixel wider if the width is odd.

    A row that ends within a pair takes the second half of its last colour from the pair before.
    """
    import numpy as np

    pixels = pixel_rows(data, width, height, step, 2).reshape(height, width, 2)
    if width % 2 == 0:
        return pixels
    before = pixels[:, -2:-1] if width > 1 else np.full((height, 1, 2), NO_COLOUR, np.uint8)
    return np.concatenate([pixels, before], axis=1)


def _yuv(order: str, pairs: NDArray[np.uint8]) -> Rgb:
    cv2 = opencv()
    rgb: Rgb = cv2.cvtColor(pairs, getattr(cv2, f"COLOR_YUV2RGB_{order}"))
    return rgb


def _bayer(pattern: str, numbers: NDArray[Any]) -> NDArray[Any]:
    """Return numbers of shape (height, width) in three colours, each the mean of its neighbours."""
    import numpy as np

    cv2 = opencv()
    # By an even number and mirrored, so that the pattern continues.
    wider = np.pad(numbers.astype(numbers.dtype.newbyteorder("=")), BORDER, "reflect")
    colours: NDArray[Any] = cv2.cvtColor(wider, getattr(cv2, f"COLOR_Bayer{pattern}2RGB"))
    return colours[BORDER:-BORDER, BORDER:-BORDER]


def _stretched(numbers: NDArray[Any]) -> Rgb:
    """Scale the greatest number to full brightness: most cameras send 10 or 12 of 16 bits."""
    import numpy as np

    greatest = max(1, int(numbers.max()))
    rgb: Rgb = (numbers.astype(np.uint32) * 255 // greatest).astype(np.uint8)
    return rgb

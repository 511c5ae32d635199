"""A picture for the recorded camera: colour bars above a grey ramp."""

from __future__ import annotations

import numpy as np

_BARS = ((192, 192, 192), (0, 192, 192), (192, 192, 0), (0, 192, 0), (192, 0, 192), (0, 0, 192))


def colour_bars(width: int = 640, height: int = 480) -> bytes:
    """Return a bgr8 picture, row after row: six bars, below them a ramp from black to white."""
    picture = np.zeros((height, width, 3), np.uint8)
    columns = np.arange(width) * len(_BARS) // width
    picture[: height * 3 // 4] = np.array(_BARS, np.uint8)[columns]
    picture[height * 3 // 4 :] = np.linspace(0, 255, width).astype(np.uint8)[:, None]
    return picture.tobytes()

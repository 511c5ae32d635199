"""The colours of the picture: numbers of one byte, cheap to compare and to keep.

The first ones have a meaning, and the screen chooses their colours; then follow a ramp from small
to large values, and a coarse cube of red, green and blue.
"""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

Paints: TypeAlias = "NDArray[np.uint8]"

LEVELS = 6
"""Of each channel of the cube."""
RAMP_FROM, RAMP_STEPS = 16, 10
CUBE_FROM = 32


class Tint(IntEnum):
    """Colours with a meaning."""

    NOTHING = 0
    """The background."""
    TEXT = 1
    MUTED = 2
    ACCENT = 3
    SECOND = 4
    GOOD = 5
    WARN = 6
    BAD = 7
    X_AXIS = 8
    Y_AXIS = 9
    Z_AXIS = 10
    FREE = 11
    """Floor of a map on which nothing stands."""
    MAYBE = 12
    """Neither free nor occupied, but measured."""
    WALL = 13
    """What a map shows as occupied."""


RGB = {Tint.X_AXIS: (235, 80, 70), Tint.Y_AXIS: (90, 200, 90), Tint.Z_AXIS: (90, 140, 255)}
"""The colours that REP-103 and every viewer give to axes."""
_STOPS = ((70, 90, 230), (40, 180, 220), (70, 200, 90), (235, 200, 60), (235, 80, 60))
"""From small to large."""


def ramp(values: NDArray[np.floating], least: float, most: float) -> Paints:
    """Return the paint of each value, from the first of the ramp for `least` to the last."""
    span = most - least
    if not span > 0:
        return np.full(len(values), RAMP_FROM, dtype=np.uint8)
    steps = (values - least) * (RAMP_STEPS / span)
    paints: Paints = (RAMP_FROM + np.clip(steps, 0, RAMP_STEPS - 1)).astype(np.uint8)
    return paints


def cube(rgb: NDArray[np.uint8]) -> Paints:
    """Return the nearest paint of the cube for colours of shape (n, 3)."""
    levels: NDArray[np.uint16] = (rgb.astype(np.uint16) * (LEVELS - 1) + 127) // 255
    number = (levels[:, 0] * LEVELS + levels[:, 1]) * LEVELS + levels[:, 2]
    paints: Paints = (CUBE_FROM + number).astype(np.uint8)
    return paints


def nearest(red: float, green: float, blue: float) -> int:
    """Return the paint of the cube nearest to a colour whose channels are 0 to 1."""
    channels = np.nan_to_num(np.array([[red, green, blue]], dtype=np.float64))
    return int(cube((np.clip(channels, 0.0, 1.0) * 255).astype(np.uint8))[0])


def rgb_of(paint: int) -> tuple[int, int, int] | None:
    """Return the colour of a paint; None for one whose colour the screen chooses."""
    if paint >= CUBE_FROM:
        number = paint - CUBE_FROM
        scale = 255 // (LEVELS - 1)
        channels = (number // LEVELS**2, number // LEVELS % LEVELS, number % LEVELS)
        return channels[0] * scale, channels[1] * scale, channels[2] * scale
    if paint >= RAMP_FROM:
        at = (paint - RAMP_FROM) / (RAMP_STEPS - 1) * (len(_STOPS) - 1)
        first = min(int(at), len(_STOPS) - 2)
        low, high, share = _STOPS[first], _STOPS[first + 1], at - first
        mixed = [round(a + (b - a) * share) for a, b in zip(low, high, strict=True)]
        return mixed[0], mixed[1], mixed[2]
    return RGB.get(Tint(paint))

"""Dots as characters: braille has two by four in a cell, which is about square on a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

BLANK, BRAILLE = 0x20, 0x2800
DOTS_ACROSS, DOTS_DOWN = 2, 4
_WEIGHTS = np.array([[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]], dtype=np.uint8)
"""Unicode 15, 22.1: which bit of the character is which dot."""

Spot = tuple[float, float]
"""x to the right and y downwards, in dots."""


def characters(on: NDArray[np.bool_]) -> NDArray[np.uint16]:
    """Return the character of each cell, for dots of shape (4 * rows, 2 * columns)."""
    height, width = on.shape
    cells = on.reshape(height // DOTS_DOWN, DOTS_DOWN, width // DOTS_ACROSS, DOTS_ACROSS)
    bits = np.einsum("rycx,yx->rc", cells, _WEIGHTS).astype(np.uint16)
    return np.where(bits > 0, bits + np.uint16(BRAILLE), np.uint16(BLANK))


def clipped(start: Spot, end: Spot, width: float, height: float) -> tuple[Spot, Spot] | None:
    """Return the part of a line within 0..width, 0..height; None if there is none.

    Source: Liang and Barsky, A New Concept and Method for Line Clipping, 1984.
    """
    first, last = 0.0, 1.0
    for begin, way, most in ((start[0], end[0] - start[0], width), (start[1], end[1] - start[1], height)):
        if way == 0.0:
            if not 0 <= begin <= most:
                return None
            continue
        near, far = sorted((-begin / way, (most - begin) / way))
        first, last = max(first, near), min(last, far)
    if not first <= last:
        return None
    x, y = end[0] - start[0], end[1] - start[1]
    return ((start[0] + x * first, start[1] + y * first), (start[0] + x * last, start[1] + y * last))

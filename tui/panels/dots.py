"""Lines on a grid of braille dots: two by four in every cell, about square on a terminal."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tui.widgets.drawing import Ink, Line

Point = tuple[float, float]
"""x to the right and y downwards, in dots."""

_BITS = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))
BLANK = 0x2800


class Dots:
    """A grid of cells; a cell takes the look of the last thing drawn in it."""

    def __init__(self, columns: int, rows: int) -> None:
        """Create a blank grid of this size, in cells."""
        self.width, self.height = 2 * columns, 4 * rows
        self._bits = [[0] * columns for _row in range(rows)]
        self._looks = [[""] * columns for _row in range(rows)]

    def dot(self, x: float, y: float, look: str = "") -> None:
        """Set one dot; one outside the grid is ignored."""
        column, row = math.floor(x), math.floor(y)
        if 0 <= column < self.width and 0 <= row < self.height:
            self._bits[row // 4][column // 2] |= _BITS[row % 4][column % 2]
            self._looks[row // 4][column // 2] = look

    def line(self, start: Point, end: Point, look: str = "") -> None:
        steps = max(1, math.ceil(max(abs(end[0] - start[0]), abs(end[1] - start[1]))))
        for step in range(steps + 1):
            share = step / steps
            x = start[0] + (end[0] - start[0]) * share
            y = start[1] + (end[1] - start[1]) * share
            self.dot(x, y, look)

    def outline(self, corners: Sequence[Point], look: str = "") -> None:
        """Draw a closed figure."""
        for start, end in zip(corners, (*corners[1:], corners[0]), strict=True):
            self.line(start, end, look)

    def fill(self, corners: Sequence[Point], look: str = "") -> None:
        """Fill a closed convex figure."""
        top, bottom = min(y for _x, y in corners), max(y for _x, y in corners)
        for y in range(math.floor(top), math.ceil(bottom) + 1):
            crossings = _crossings(corners, y + 0.5)
            if crossings:
                for x in range(math.floor(min(crossings)), math.ceil(max(crossings))):
                    self.dot(x, y, look)

    def lines(self) -> list[Line]:
        """Return the grid as lines of ink."""
        return [
            [
                Ink(chr(BLANK + bits) if bits else " ", look if bits else "")
                for bits, look in zip(row, looks, strict=True)
            ]
            for row, looks in zip(self._bits, self._looks, strict=True)
        ]


def _crossings(corners: Sequence[Point], y: float) -> list[float]:
    found: list[float] = []
    for (x1, y1), (x2, y2) in zip(corners, (*corners[1:], corners[0]), strict=True):
        if (y1 <= y) != (y2 <= y):
            found.append(x1 + (x2 - x1) * (y - y1) / (y2 - y1))
    return found


def rectangle(centre: Point, width: float, length: float, angle_rad: float) -> list[Point]:
    """Corners of a rectangle that is `length` long upwards, rotated anticlockwise by the angle."""
    sin, cos = math.sin(angle_rad), math.cos(angle_rad)
    corners: list[Point] = []
    for across, along in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
        x, y = across * width / 2, along * length / 2
        corners.append((centre[0] + x * cos + y * sin, centre[1] - x * sin + y * cos))
    return corners

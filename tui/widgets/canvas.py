"""A canvas of braille dots, two by four in every cell; a bar with its scale; what has changed."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from space.drawing.braille import BLANK, characters, clipped
from text.i18n import _, decimal
from tui.widgets.drawing import LOOKS, Ink, Line

Point = tuple[float, float]
"""x to the right and y downwards, in dots."""

GRID = "·"
SPOT = 4
"""Half the size of any other sign where dots are pixels, in dots."""
_LOOKS = ("", *LOOKS)
_NUMBER = {look: number for number, look in enumerate(_LOOKS)}


class Canvas:
    """A grid of cells; a cell takes the look of the last thing drawn in it."""

    def __init__(self, columns: int, rows: int) -> None:
        """Create a blank grid of this size, in cells."""
        self.columns, self.rows = columns, rows
        self.width, self.height = 2 * columns, 4 * rows
        self._on = np.zeros((self.height, self.width), dtype=np.bool_)
        self._looks = np.zeros((rows, columns), dtype=np.uint8)
        self._signs: dict[tuple[int, int], str] = {}

    def dots(self, x: NDArray[np.float64], y: NDArray[np.float64], look: str = "") -> None:
        """Set dots, x to the right and y downwards; those outside are ignored."""
        inside = (x >= 0) & (x < self.width) & (y >= 0) & (y < self.height)
        column, row = x[inside].astype(np.intp), y[inside].astype(np.intp)
        self._on[row, column] = True
        self._looks[row // 4, column // 2] = _NUMBER[look]

    def mask(self, on: NDArray[np.bool_], look: str = "") -> None:
        self._on |= on
        touched = on.reshape(self.rows, 4, self.columns, 2).any(axis=(1, 3))
        self._looks[touched] = _NUMBER[look]

    def dotted(self, row: int, look: str = "") -> None:
        """Put a dot into every fourth cell of a row, where nothing is drawn."""
        for column in range(0, self.columns, 4):
            if not self._on[4 * row : 4 * row + 4, 2 * column : 2 * column + 2].any():
                self.sign((2.0 * column, 4.0 * row), GRID, look)

    def line(self, start: Point, end: Point, look: str = "", dash: tuple[int, int] = (1, 0)) -> None:
        """Draw a straight line; `dash` is how many dots are set and how many left out in turn."""
        inside = clipped(start, end, self.width, self.height)
        if inside is None:
            return
        (x0, y0), (x1, y1) = inside
        steps = max(1, int(np.ceil(max(abs(x1 - x0), abs(y1 - y0)))))
        shares = np.linspace(0.0, 1.0, steps + 1)
        shares = shares[np.arange(steps + 1) % sum(dash) < dash[0]]
        self.dots(x0 + (x1 - x0) * shares, y0 + (y1 - y0) * shares, look)

    def outline(self, corners: list[Point], look: str = "") -> None:
        for start, end in zip(corners, (*corners[1:], corners[0]), strict=True):
            self.line(start, end, look)

    def fill(self, corners: list[Point], look: str = "") -> None:
        """Set all dots whose centre is in a closed convex figure."""
        shape = np.array(corners)
        least = np.clip(np.floor(shape.min(axis=0)), 0, (self.width, self.height)).astype(int)
        most = np.clip(np.ceil(shape.max(axis=0)), 0, (self.width, self.height)).astype(int)
        x, y = np.meshgrid(np.arange(least[0], most[0]) + 0.5, np.arange(least[1], most[1]) + 0.5)
        along = np.roll(shape, -1, axis=0) - shape
        sides = [
            dx * (y - y0) - dy * (x - x0) for (x0, y0), (dx, dy) in zip(shape.tolist(), along.tolist(), strict=True)
        ]
        inside = np.all([side >= 0 for side in sides], axis=0)
        inside |= np.all([side <= 0 for side in sides], axis=0)
        self.dots(x[inside], y[inside], look)

    def sign(self, place: Point, char: str, look: str = "") -> None:
        """Put a character in place of a cell's dots; one outside is ignored."""
        if 0 <= place[0] < self.width and 0 <= place[1] < self.height:
            row, column = int(place[1]) // 4, int(place[0]) // 2
            self._signs[row, column] = char
            self._looks[row, column] = _NUMBER[look]

    def rgb(self, colours: Mapping[str, tuple[int, int, int]], ground: tuple[int, int, int]) -> NDArray[np.uint8]:
        """Return the canvas with a pixel for each dot; a sign is a spot of the size of some cells."""
        on, looks = self._on.copy(), self._looks.repeat(4, axis=0).repeat(2, axis=1)
        for (row, column), char in self._signs.items():
            size = 1 if char == GRID else SPOT
            y, x = 4 * row + 2, 2 * column + 1
            spot = slice(max(0, y - size), y + size), slice(max(0, x - size), x + size)
            on[spot], looks[spot] = True, self._looks[row, column]
        palette = np.array([colours[look] for look in _LOOKS], np.uint8)
        pixels: NDArray[np.uint8] = np.where(on[..., None], palette[looks], np.array(ground, np.uint8))
        return pixels

    def lines(self) -> list[Line]:
        """Return the canvas as lines of ink; neighbours that look alike share one."""
        codes = characters(self._on).astype("<u2")
        for place, char in self._signs.items():
            codes[place] = ord(char)
        looks = np.where(codes == BLANK, 0, self._looks)
        return [_line(codes[row], looks[row]) for row in range(self.rows)]


def _line(codes: NDArray[np.uint16], looks: NDArray[np.uint8]) -> Line:
    text = codes.tobytes().decode("utf-16-le")
    starts = [0, *(np.flatnonzero(np.diff(looks)) + 1).tolist()]
    return [
        Ink(text[start:end], _LOOKS[looks[start]])
        for start, end in zip(starts, (*starts[1:], len(text)), strict=True)
    ]


def rectangle(centre: Point, width: float, length: float, angle_rad: float) -> list[Point]:
    """Corners of a rectangle that is `length` long upwards, rotated anticlockwise by the angle."""
    sin, cos = math.sin(angle_rad), math.cos(angle_rad)
    corners: list[Point] = []
    for across, along in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
        x, y = across * width / 2, along * length / 2
        corners.append((centre[0] + x * cos + y * sin, centre[1] - x * sin + y * cos))
    return corners


BAR_M = (1, 2, 5)
"""First digits of the length of a scale bar."""
BAR_CELLS = 12


def scale_bar(dots_per_m: float) -> Line:
    """A bar for a round number of metres, as long as that is in the picture."""
    # The longest of 1, 2, 5, 10, ... metres, or fractions, that fits.
    most_m = BAR_CELLS * 2 / dots_per_m
    power = 10.0 ** math.floor(math.log10(most_m))
    metres = max(digit * power for digit in BAR_M if digit * power <= most_m * (1 + 1e-9))
    cells = max(1, round(metres * dots_per_m / 2))
    bar = "├" + "─" * (cells - 2) + "┤" if cells > 1 else "│"
    return [Ink(f"{bar} "), Ink(_("{metres} m").format(metres=decimal(f"{metres:g}")), "strong")]


JUMP = 4
"""A run of unchanged cells this short is cheaper to redraw than to skip."""


def spans(cells: NDArray[np.bool_]) -> list[tuple[int, int, int]]:
    """Runs of cells, as (row, first column, columns).

    Those that are close together in a row are one: moving the cursor costs bytes too.
    """
    found: list[tuple[int, int, int]] = []
    for row in np.flatnonzero(cells.any(axis=1)).tolist():
        columns = np.flatnonzero(cells[row])
        breaks = np.flatnonzero(np.diff(columns) > JUMP)
        starts = columns[np.concatenate(([0], breaks + 1))].tolist()
        ends = columns[np.concatenate((breaks, [len(columns) - 1]))].tolist()
        found.extend((row, a, b - a + 1) for a, b in zip(starts, ends, strict=True))
    return found

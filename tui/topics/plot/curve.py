"""A history as braille dots: a column of dots spans its lowest to its highest number."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from tui.topics.plot.axis import ValueAxis
    from tui.topics.plot.history import HistoryDots, Numbers

    Cells: TypeAlias = NDArray[np.uint8]
    """Shape (rows, columns): the dots of each braille cell."""

DOTS_ACROSS, DOTS_DOWN = 2, 4
_BITS = np.array([[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]], np.uint8)


def heights(values: Numbers, axis: ValueAxis, dots: int) -> Numbers:
    """Rows of dots from the top, 0..dots-1, for numbers on this axis; nan stays nan."""
    share = (axis.high - values) / (axis.high - axis.low)
    placed: Numbers = np.clip(np.rint(share * (dots - 1)), 0, dots - 1)
    return placed


def curve(columns: HistoryDots, axis: ValueAxis, rows: int) -> Cells:
    """The dots of a curve in this many rows of cells, two columns of dots in each cell."""
    dots = rows * DOTS_DOWN
    top, bottom = _reach(columns, axis, dots)
    at = np.arange(dots)[:, None]
    grid = (at >= top) & (at <= bottom)
    width = len(columns.low) // DOTS_ACROSS
    cells = grid.reshape(rows, DOTS_DOWN, width, DOTS_ACROSS).astype(np.uint8)
    drawn: Cells = (cells * _BITS[None, :, None, :]).sum(axis=(1, 3), dtype=np.uint8)
    return drawn


def _reach(columns: HistoryDots, axis: ValueAxis, dots: int) -> tuple[Numbers, Numbers]:
    """First and last row of each column of dots, including the lines between numbers; nan: none."""
    # Lists: numpy is slower than a loop for single numbers.
    top = heights(columns.high, axis, dots).tolist()
    bottom = heights(columns.low, axis, dots).tolist()
    last = heights(columns.last, axis, dots).tolist()
    seen = np.flatnonzero(np.isfinite(columns.low)).tolist()
    broken = columns.broken.tolist()
    for left, right in pairwise(seen):
        if not broken[right]:
            # From the last number of one column to the nearest number of the next.
            end = min(max(last[left], top[right]), bottom[right])
            _join(top, bottom, (left, last[left]), (right, end))
    return np.array(top), np.array(bottom)


def _join(top: list[float], bottom: list[float], start: tuple[int, float], end: tuple[int, float]) -> None:
    """Draw a line, making each column high enough to connect all dots."""
    (left, begin), (right, finish) = start, end
    slope = (finish - begin) / (right - left)
    one = begin
    for column in range(left, right + 1):
        other = finish if column == right else math.floor(begin + slope * (column + 0.5 - left))
        if math.isnan(top[column]):
            top[column], bottom[column] = min(one, other), max(one, other)
        else:
            top[column] = min(top[column], one, other)
            bottom[column] = max(bottom[column], one, other)
        one = other

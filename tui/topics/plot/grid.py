"""Overlapping curves in braille cells, above dotted lines at the ticks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tui.widgets.drawing import Ink, Line

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from tui.topics.plot.curve import Cells

BLANK = 0x2800
EVERY = 4
"""Cells between two dots of the line of a tick."""


class PlotGrid:
    """A grid of cells; each takes the look of the last curve drawn through it."""

    def __init__(self, rows: int, columns: int, ticks: Iterable[int]) -> None:
        """Start with dotted lines in the rows of the ticks."""
        self._bits = np.zeros((rows, columns), np.uint8)
        self._owners = np.zeros((rows, columns), np.int8)
        """0 for no curve, otherwise the number of the curve."""
        self._ticks = set(ticks)

    def draw(self, cells: Cells, number: int) -> None:
        """Draw a curve over the existing ones; curves are numbered from 1."""
        self._bits |= cells
        self._owners[cells > 0] = number

    def lines(self, looks: Sequence[str]) -> list[Line]:
        """Return the rows, joining neighbours that look alike; `looks` are those of the curves."""
        return [self._line(row, ("muted", *looks)) for row in range(len(self._bits))]

    def _line(self, row: int, looks: Sequence[str]) -> Line:
        codes = np.where(self._bits[row] > 0, BLANK + self._bits[row].astype(np.int32), ord(" "))
        if row in self._ticks:
            codes[::EVERY] = np.where(codes[::EVERY] == ord(" "), ord("·"), codes[::EVERY])
        text = "".join(map(chr, codes.tolist()))
        owners = self._owners[row]
        starts = [0, *(np.flatnonzero(np.diff(owners)) + 1).tolist()]
        ends = [*starts[1:], len(text)]
        return [Ink(text[start:end], looks[int(owners[start])]) for start, end in zip(starts, ends, strict=True)]

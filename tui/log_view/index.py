"""Which lines of the ring are shown, and on which rows: kept up to date line by line.

Rows are counted from the first shown line. A line takes one row, or as many as its text needs
when it is folded to a width.
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Sequence
from itertools import accumulate, chain, pairwise
from operator import attrgetter

from rich.cells import cell_len, chop_cells

from tui.log_view.filter import LogFilter
from tui.log_view.ring import LogEntry

_id_of = attrgetter("id")


_narrow = re.compile(
    "[ -~\xa0-\xac\xae-\u02ff\u0370-\u0482\u048a-\u052f\u2010-\u2027\u2400-\u2421]*"
).fullmatch
"""Matches texts of which every character takes one cell."""


def folded(text: str, width: int) -> list[str]:
    """The text cut into rows of at most `width` cells, and a blank at the end of a row.

    Rows end between words where the row is at least half full then; texts with wide or joined
    characters are cut anywhere between these.
    """
    if not _narrow(text):
        chopped = chop_cells(text, width) or [""]
        # A tail of characters without width is left out by `chop_cells`.
        chopped[-1] += text[sum(map(len, chopped)) :]
        return chopped
    pieces: list[str] = []
    at, end = 0, len(text)
    while end - at > width:
        cut = text.rfind(" ", at + width // 2, at + width + 1) + 1 or at + width
        pieces.append(text[at:cut])
        at = cut
    if at < end or not pieces:
        pieces.append(text[at:])
    return pieces


def folded_rows(text: str, width: int) -> int:
    """How many rows `folded` makes, without making them where that can be told."""
    if len(text) <= width and (text.isascii() or cell_len(text) <= width):
        return 1
    return len(folded(text, width))


class LogIndex:
    """The shown lines in order, the rows that they take, and those that a search found."""

    def __init__(self, text_of: Callable[[LogEntry], str]) -> None:
        """`text_of` gives the text that is drawn for an entry."""
        self.text_of = text_of
        self.filter = LogFilter()
        self.fold_width: int | None = None
        """Cells of text in a row; None when lines are not folded."""
        self.shown: list[LogEntry] = []
        self.found: list[int] = []
        """Ids of the shown lines that hold the text searched for."""
        self.longest = 0
        """Cells of the longest text shown, or a little more."""
        self._ends: list[int] = []

    @property
    def rows(self) -> int:
        """Rows that all shown lines take."""
        if self.fold_width is None:
            return len(self.shown)
        return self._ends[-1] if self._ends else 0

    def extend(self, entries: Sequence[LogEntry]) -> int:
        """Take in entries that are newer than all before; return how many of them are shown."""
        chosen, pattern = self.filter, self.filter.pattern
        find = pattern.search if pattern else None
        visible = {node: chosen.shows_node(node) for node in {entry.node for entry in entries}}
        minimum, only_found = chosen.minimum.rank, chosen.only_found and find is not None
        before = len(self.shown)
        for entry in entries:
            if not visible[entry.node] or (entry.rank < minimum and not entry.skipped):
                continue
            if find and not entry.skipped and find(entry.text):
                self.found.append(entry.id)
            elif only_found:
                continue
            self.shown.append(entry)
        self._measure(self.shown[before:])
        return len(self.shown) - before

    def _measure(self, entries: Sequence[LogEntry]) -> None:
        width, text_of = self.fold_width, self.text_of
        if width is None:
            for entry in entries:
                if len(entry.text) > self.longest or not entry.text.isascii():
                    self.longest = max(self.longest, cell_len(text_of(entry)))
            return
        end, ends = self.rows, self._ends
        for entry in entries:
            end += folded_rows(text_of(entry), width)
            ends.append(end)

    def rebuild(self, entries: Sequence[LogEntry]) -> None:
        """Begin anew with all entries there are: the filter or the ring has changed."""
        self.shown, self.found, self._ends, self.longest = [], [], [], 0
        self.extend(entries)

    def prune(self, marks: Sequence[LogEntry] = ()) -> None:
        """Leave out the entries that the ring has dropped, put in the marks it made for them."""
        shown = [entry for entry in self.shown if not entry.dropped]
        heights = [end - start for start, end in pairwise(chain((0,), self._ends))]
        kept = [
            height for entry, height in zip(self.shown, heights, strict=False) if not entry.dropped
        ]
        gone = {entry.id for entry in self.shown if entry.dropped}
        self.found = [entry_id for entry_id in self.found if entry_id not in gone]
        self.shown = shown
        only_found = self.filter.only_found and bool(self.filter.search)
        for mark in () if only_found else marks:
            if self.filter.shows_node(mark.node):
                place = self.place_of(mark.id)
                shown.insert(place, mark)
                if self.fold_width is not None:
                    kept.insert(place, folded_rows(self.text_of(mark), self.fold_width))
        self._ends = list(accumulate(kept))

    def fold(self, width: int | None) -> None:
        """Fold the lines to so many cells, or not at all."""
        self.fold_width, self._ends, self.longest = width, [], 0
        self._measure(self.shown)

    def locate(self, row: int) -> tuple[int, int]:
        """Place in `shown` of the line on this row, and the how-manieth of its rows it is."""
        if self.fold_width is None:
            return row, 0
        place = bisect_right(self._ends, row)
        return place, row - self.row_of(place)

    def row_of(self, place: int) -> int:
        """First row of the line at this place in `shown`."""
        if self.fold_width is None or place == 0:
            return place
        return self._ends[place - 1]

    def place_of(self, entry_id: int) -> int:
        """Place in `shown` of this entry, or of the next one that is shown."""
        return bisect_left(self.shown, entry_id, key=_id_of)

    def found_near(self, entry_id: int, step: int) -> int | None:
        """Id of the next found line after (`step` 1) or before (-1) this one, around the ends."""
        if not self.found:
            return None
        if step > 0:
            at = bisect_right(self.found, entry_id)
            return self.found[at % len(self.found)]
        return self.found[bisect_left(self.found, entry_id) - 1]

    def found_number(self, entry_id: int | None) -> int:
        """Which of the found lines this is, from 1; 0 if it is none of them."""
        if entry_id is None:
            return 0
        at = bisect_left(self.found, entry_id)
        return at + 1 if at < len(self.found) and self.found[at] == entry_id else 0

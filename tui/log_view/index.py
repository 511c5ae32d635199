"""Which lines of the ring are shown, and on which rows: updated line by line.

Rows are counted from the first shown line. A line takes one row, or as many as its text needs when
it is wrapped.
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Sequence
from itertools import accumulate, chain, pairwise
from operator import attrgetter

from rich.cells import cell_len, chop_cells, get_character_cell_size

from tui.log_view.filter import LogFilter
from tui.log_view.ring import LogEntry

_id_of = attrgetter("id")


_narrow = re.compile("[ -~\xa0-\xac\xae-\u02ff\u0370-\u0482\u048a-\u052f\u2010-\u2027\u2400-\u2421]*").fullmatch
"""Matches texts in which every character takes one cell."""
_JOINER = "\u200d"
"""Joins two emoji into one."""
_EMOJI_STYLE = "\ufe0f"
"""Makes the character before it a wide emoji."""


def folded(text: str, width: int) -> list[str]:
    """Return the text cut into rows of at most `width` cells, and a blank at the end of a row.

    Rows end between words if the row is then at least half full; texts with wide or combining
    characters are cut between any two characters.
    """
    if not _narrow(text):
        chopped = chop_cells(text, width) or [""]
        # `chop_cells` drops trailing characters without width.
        chopped[-1] += text[sum(map(len, chopped)) :]
        if _JOINER in text and any(cell_len(row) > width for row in chopped):
            return _cut_by_character(text, width)
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


def _cut_by_character(text: str, width: int) -> list[str]:
    """Return rows of a text in which Rich counts a character beside a joiner as nothing.

    Each character has its own width here, as if none were joined, so a row is never too wide.
    """
    rows: list[str] = []
    start = used = 0
    for at, character in enumerate(text):
        size = 1 if character == _EMOJI_STYLE else get_character_cell_size(character)
        if used + size > width:
            rows.append(text[start:at])
            start, used = at, 0
        used += size
    return [*rows, text[start:]]


def folded_rows(text: str, width: int) -> int:
    """Return the number of rows that `folded` makes, without making them where possible."""
    if len(text) <= width and (text.isascii() or (_JOINER not in text and cell_len(text) <= width)):
        return 1
    return len(folded(text, width))


class LogIndex:
    """The shown lines in order, the rows that they take, and the matches of a search."""

    def __init__(self, text_of: Callable[[LogEntry], str]) -> None:
        """Pass `text_of`, which returns the text that is drawn for an entry."""
        self.text_of = text_of
        self.filter = LogFilter()
        self.fold_width: int | None = None
        """Cells of text in a row; None if lines are not wrapped."""
        self.shown: list[LogEntry] = []
        self.found: list[int] = []
        """Ids of the shown lines that contain the search text."""
        self.longest = 0
        """Cells of the longest text shown, or slightly more."""
        self._ends: list[int] = []

    @property
    def rows(self) -> int:
        """Number of rows that all shown lines take."""
        if self.fold_width is None:
            return len(self.shown)
        return self._ends[-1] if self._ends else 0

    def extend(self, entries: Sequence[LogEntry]) -> int:
        """Add entries newer than all existing ones; return how many of them are shown."""
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
        """Rebuild from all entries, because the filter or the ring has changed."""
        self.shown, self.found, self._ends, self.longest = [], [], [], 0
        self.extend(entries)

    def prune(self, marks: Sequence[LogEntry] = ()) -> None:
        """Remove the entries that the ring has dropped, and insert its marks for them."""
        shown = [entry for entry in self.shown if not entry.dropped]
        heights = [end - start for start, end in pairwise(chain((0,), self._ends))]
        kept = [height for entry, height in zip(self.shown, heights, strict=False) if not entry.dropped]
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
        """Wrap the lines to this width, or not at all."""
        self.fold_width, self._ends, self.longest = width, [], 0
        self._measure(self.shown)

    def locate(self, row: int) -> tuple[int, int]:
        """Index in `shown` of the line on this row, and the number of the row within the line."""
        if self.fold_width is None:
            return row, 0
        place = bisect_right(self._ends, row)
        return place, row - self.row_of(place)

    def row_of(self, place: int) -> int:
        """First row of the line at this index in `shown`."""
        if self.fold_width is None or place == 0:
            return place
        return self._ends[place - 1]

    def place_of(self, entry_id: int) -> int:
        """Index in `shown` of this entry, or of the next one that is shown."""
        return bisect_left(self.shown, entry_id, key=_id_of)

    def found_near(self, entry_id: int, step: int) -> int | None:
        """Id of the next match after (`step` 1) or before (-1) this line, wrapping at the ends."""
        if not self.found:
            return None
        if step > 0:
            at = bisect_right(self.found, entry_id)
            return self.found[at % len(self.found)]
        return self.found[bisect_left(self.found, entry_id) - 1]

    def found_number(self, entry_id: int | None) -> int:
        """Number of this line among the matches, from 1; 0 if it is not one of them."""
        if entry_id is None:
            return 0
        at = bisect_left(self.found, entry_id)
        return at + 1 if at < len(self.found) and self.found[at] == entry_id else 0

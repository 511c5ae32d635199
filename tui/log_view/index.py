"""Which lines of the ring are shown, on which rows, and which of them are chosen: updated line by line.

Rows are counted from the first shown line. A line takes one row, or as many as its text needs when
it is wrapped.
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter

from rich.cells import cell_len, chop_cells, get_character_cell_size

from launcher.status import Severity
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


@dataclass(frozen=True)
class LogFilter:
    """Selects lines. It is immutable: every change returns a new one."""

    muted: frozenset[str] = frozenset()
    """Nodes whose lines are hidden, unless only one node is shown."""
    only: str | None = None
    """The only node that is shown; all others are muted."""
    minimum: Severity = Severity.DEBUG
    search: str = ""
    """Text to search for, ignoring case; if empty, there are no matches."""
    only_found: bool = False
    """Whether lines without that text are hidden."""

    def shows_node(self, node: str) -> bool:
        if self.only is not None:
            return node == self.only
        return node not in self.muted

    @property
    def pattern(self) -> re.Pattern[str] | None:
        return re.compile(re.escape(self.search), re.IGNORECASE) if self.search else None

    def toggled(self, node: str) -> LogFilter:
        """Mute this node, or unmute it; this also ends showing a single node."""
        return replace(self, muted=self.muted ^ {node}, only=None)

    def alone(self, node: str) -> LogFilter:
        """Show only this node; if called again for it, restore the previous state."""
        return replace(self, only=None if self.only == node else node)

    def all_nodes(self) -> LogFilter:
        return replace(self, muted=frozenset(), only=None)

    def next_minimum(self) -> LogFilter:
        """Raise the lowest severity shown by one level; after the highest comes the lowest."""
        levels = list(Severity)
        return replace(self, minimum=levels[(self.minimum.rank + 1) % len(levels)])


class LogIndex:
    """The shown lines in order, the rows that they take, and the matches of a search."""

    def __init__(self, text_of: Callable[[LogEntry], str]) -> None:
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

    def fold(self, width: int | None) -> None:
        self.fold_width, self._ends, self.longest = width, [], 0
        self._measure(self.shown)

    def locate(self, row: int) -> tuple[int, int]:
        """Index in `shown` of the line on this row, and the number of the row within the line."""
        if self.fold_width is None:
            return row, 0
        place = bisect_right(self._ends, row)
        return place, row - self.row_of(place)

    def row_of(self, place: int) -> int:
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


class LineChoice:
    """A range of the lines in an index, by id; empty until one is chosen."""

    def __init__(self, index: LogIndex) -> None:
        self.cursor: int | None = None
        self._anchor: int | None = None
        """Where the choice began."""
        self._index = index

    def move(self, entry_id: int, *, extend: bool) -> None:
        """Choose a line; with `extend`, all lines from where the choice began to it."""
        if not extend or self._anchor is None:
            self._anchor = self.cursor if extend and self.cursor is not None else entry_id
        self.cursor = entry_id

    def clear(self) -> None:
        self.cursor = self._anchor = None

    @property
    def _span(self) -> tuple[int, int]:
        """Lowest and highest chosen id."""
        if self.cursor is None or self._anchor is None:
            return 0, -1
        return min(self.cursor, self._anchor), max(self.cursor, self._anchor)

    def __contains__(self, entry_id: int) -> bool:
        first, last = self._span
        return first <= entry_id <= last

    @property
    def entries(self) -> Sequence[LogEntry]:
        first, last = self._span
        return self._index.shown[self._index.place_of(first) : self._index.place_of(last + 1)]

    @property
    def node(self) -> str | None:
        return next((entry.node for entry in self.entries if entry.id == self.cursor), None)

    @property
    def found_number(self) -> int:
        """Number of the match at the cursor, from 1; 0 if there is none."""
        found, cursor = self._index.found, self.cursor
        return found.index(cursor) + 1 if cursor in found else 0

"""The chosen lines of a log: a cursor, and the line where the choice began."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from datetime import datetime
from typing import TYPE_CHECKING

from text.plain import plain
from tui.log_view.rows import WORD_CELLS, WORDS

if TYPE_CHECKING:
    from tui.log_view.index import LogIndex
    from tui.log_view.ring import LogEntry


class LineChoice:
    """A range of the lines in an index, by id; empty until one is chosen."""

    def __init__(self, index: LogIndex) -> None:
        self.cursor: int | None = None
        self._anchor: int | None = None
        self._index = index

    def move(self, entry_id: int, *, extend: bool) -> None:
        """Choose a line; with `extend`, all lines from where the choice began to it."""
        if not extend or self._anchor is None:
            self._anchor = self.cursor if extend and self.cursor is not None else entry_id
        self.cursor = entry_id

    def clear(self) -> None:
        self.cursor = self._anchor = None

    def __contains__(self, entry_id: int) -> bool:
        span = self._span
        return span is not None and span[0] <= entry_id <= span[1]

    @property
    def entries(self) -> Sequence[LogEntry]:
        span = self._span
        if span is None:
            return ()
        first, end = self._index.place_of(span[0]), self._index.place_of(span[1] + 1)
        return self._index.shown[first:end]

    @property
    def node(self) -> str | None:
        """Node of the line at the cursor, None without a cursor."""
        return next((entry.node for entry in self.entries if entry.id == self.cursor), None)

    @property
    def found_number(self) -> int:
        """Number of the match at the cursor, from 1; 0 if there is none."""
        return self._index.found_number(self.cursor)

    @property
    def _span(self) -> tuple[int, int] | None:
        """Lowest and highest chosen id, None if nothing is chosen."""
        if self.cursor is None or self._anchor is None:
            return None
        return min(self.cursor, self._anchor), max(self.cursor, self._anchor)


def exported(entries: Iterable[LogEntry], index: LogIndex) -> list[str]:
    """Lines for the clipboard or a file: local date and time, severity, node, text."""
    return [_exported(entry, index.text_of(entry)) for entry in entries]


def _exported(entry: LogEntry, text: str) -> str:
    try:
        stamp = datetime.fromtimestamp(entry.time_s).astimezone().isoformat(" ", "milliseconds")
    except (OverflowError, ValueError, OSError):
        stamp = "-"
    word = "-----" if entry.skipped else WORDS[entry.rank].ljust(WORD_CELLS)
    return f"{stamp[:23]} {word} {plain(entry.node)}: {text}"

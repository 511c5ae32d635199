"""The lines that a person has chosen in a log: a cursor, and how far back the choice reaches."""

from __future__ import annotations

from datetime import datetime

from text.plain import plain
from tui.log_view.ring import Entry
from tui.log_view.rows import WORD_CELLS, WORDS


class Choice:
    """A range of lines by their ids; empty until a line is pointed at."""

    def __init__(self) -> None:
        self.cursor: int | None = None
        self._anchor: int | None = None

    def move(self, entry_id: int, *, extend: bool) -> None:
        """Point at a line; with `extend` choose all from where the choice began to it."""
        if not extend or self._anchor is None:
            self._anchor = self.cursor if extend and self.cursor is not None else entry_id
        self.cursor = entry_id

    def clear(self) -> None:
        """Choose nothing."""
        self.cursor = self._anchor = None

    @property
    def span(self) -> tuple[int, int] | None:
        """Lowest and highest id chosen, None if nothing is."""
        if self.cursor is None or self._anchor is None:
            return None
        return min(self.cursor, self._anchor), max(self.cursor, self._anchor)

    def __contains__(self, entry_id: int) -> bool:
        span = self.span
        return span is not None and span[0] <= entry_id <= span[1]


def exported(entry: Entry, text: str) -> str:
    """A line for the clipboard or a file: local date and time, severity, node, text."""
    try:
        stamp = datetime.fromtimestamp(entry.time_s).astimezone().isoformat(" ", "milliseconds")
    except (OverflowError, ValueError, OSError):
        stamp = "-"
    word = "-----" if entry.skipped else WORDS[entry.rank].ljust(WORD_CELLS)
    return f"{stamp[:23]} {word} {plain(entry.node)}: {text}"

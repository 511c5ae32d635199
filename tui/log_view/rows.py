"""What a row of the log says, in columns: time, severity, node, text.

The severity is a word or its first letter as well as a colour. The columns in front of the text
stay in place when long lines are shifted sideways.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import lru_cache

from rich.cells import cell_len, set_cell_size

from launcher.status import Severity
from text.i18n import ngettext
from text.plain import plain
from tui.log_view.ring import LogEntry

WORDS = tuple(severity.name for severity in Severity)
WORD_CELLS = max(map(len, WORDS))


@dataclass(frozen=True)
class LogColumns:
    """Widths of the columns; 0 leaves one out."""

    time: int
    word: int
    node: int

    @property
    def gutter(self) -> int:
        """Cells in front of the text: the mark of the line, and a blank after each column."""
        return 1 + sum(cells + 1 for cells in (self.time, self.word, self.node) if cells)


def columns_for(width: int, longest_node: int) -> LogColumns:
    """Return columns that leave at least half of the width to the text."""
    if width < 40:
        return LogColumns(0, 1, min(longest_node, 6))
    if width < 70:
        return LogColumns(8, 1, min(longest_node, 10))
    if width < 140:
        return LogColumns(8, WORD_CELLS, min(longest_node, 20))
    return LogColumns(12, WORD_CELLS, min(longest_node, 32))


def text_of(entry: LogEntry, where: str = "") -> str:
    """Return the drawn text of an entry; `where` is the path of the file with all lines."""
    if not entry.skipped:
        return entry.text
    count = f"{entry.skipped:,}".replace(",", "\N{NO-BREAK SPACE}")
    if where:
        words = ngettext(
            "{count} line skipped here; the file has it: {path}",
            "{count} lines skipped here; the file has them: {path}",
            entry.skipped,
        )
        return words.format(count=count, path=where)
    words = ngettext("{count} line skipped here", "{count} lines skipped here", entry.skipped)
    return words.format(count=count)


@lru_cache(maxsize=256)
def _second(second: int) -> str:
    return time.strftime("%H:%M:%S", time.localtime(second))


def clock(time_s: float, cells: int) -> str:
    """Local time of day in this many cells, with milliseconds if they fit."""
    try:
        second, milliseconds = divmod(round(time_s * 1000), 1000)
        words = f"{_second(second)}.{milliseconds:03}"
    except (OverflowError, ValueError, OSError):
        words = "--:--:--"
    return words[:cells].ljust(cells)


def gutter_texts(entry: LogEntry, columns: LogColumns) -> tuple[str, str, str]:
    """Time, severity and node of an entry, each followed by a blank, or "" if left out.

    The time is preceded by the cell for the mark of a chosen line.
    """
    when = f" {clock(entry.time_s, columns.time)} " if columns.time else " "
    word = "⋯" if entry.skipped else WORDS[entry.rank]
    word = f"{word[: columns.word].ljust(columns.word)} " if columns.word else ""
    node = f"{_fitted(plain(entry.node), columns.node)} " if columns.node else ""
    return when, word, node


def _fitted(name: str, cells: int) -> str:
    if cell_len(name) > cells > 1:
        return set_cell_size(name, cells - 1) + "…"
    return set_cell_size(name, cells)

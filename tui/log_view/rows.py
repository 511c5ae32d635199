"""The rows of a log: what they say in columns (time, severity, node, text), and how they are drawn.

The severity is a word or its first letter as well as a colour. The columns in front of the text
stay in place when long lines are shifted sideways.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from functools import lru_cache

from rich.cells import cell_len, set_cell_size
from rich.style import Style
from rich.text import Text
from textual.cache import LRUCache
from textual.color import Color
from textual.selection import Selection
from textual.strip import Strip
from textual.widget import Widget

from launcher.status import Severity
from text.i18n import ngettext
from text.plain import plain
from tui.log_view.index import LogEntry, LogIndex, folded

WORDS = tuple(severity.name for severity in Severity)
WORD_CELLS = max(map(len, WORDS))
CHOSEN, MORE = "▌", "›"
_HUES = (200, 130, 285, 45, 170, 325, 90, 240)
"""Of the nodes, in the order in which they appear."""


@dataclass(frozen=True)
class LogColumns:
    """Widths of the columns; 0 leaves one out."""

    time: int
    word: int
    node: int

    @property
    def gutter(self) -> int:
        return 1 + sum(cells + 1 for cells in (self.time, self.word, self.node) if cells)


def columns_for(width: int, longest_node: int) -> LogColumns:
    """Return columns that leave at least half of the width to the text."""
    if width < 40:
        return LogColumns(0, 1, min(longest_node, 6))
    if width < 70:
        return LogColumns(8, 1, min(longest_node, width // 4))
    if width < 140:
        return LogColumns(8, WORD_CELLS, min(longest_node, 20))
    return LogColumns(12, WORD_CELLS, min(longest_node, 32))


def grouped(count: int) -> str:
    return f"{count:,}".replace(",", "\N{NO-BREAK SPACE}")


def text_of(entry: LogEntry, where: str = "") -> str:
    """Return the drawn text of an entry; `where` is the path of the file with all lines."""
    if not entry.skipped:
        return entry.text
    count = grouped(entry.skipped)
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
    cells = columns.node
    return when, word, f"{set_cell_size(short_name(entry.node, cells), cells)} " if cells else ""


def short_name(node: str, cells: int) -> str:
    """Cut a name in its middle: names of one robot often differ only at their end."""
    name = plain(node)
    if cell_len(name) <= cells or cells < 2:
        return name
    end = (cells - 1) // 3
    return set_cell_size(name, cells - 1 - end) + "…" + name[len(name) - end :]


def exported(entries: Sequence[LogEntry], index: LogIndex) -> list[str]:
    """Lines for the clipboard or a file: local date and time, severity, node, text."""
    lines = []
    for entry in entries:
        try:
            stamp = datetime.fromtimestamp(entry.time_s).astimezone().isoformat(" ", "milliseconds")
        except (OverflowError, ValueError, OSError):
            stamp = "-"
        word = "-----" if entry.skipped else WORDS[entry.rank].ljust(WORD_CELLS)
        lines.append(f"{stamp[:23]} {word} {plain(entry.node)}: {index.text_of(entry)}")
    return lines


def selected(selection: Selection, index: LogIndex, columns: LogColumns) -> tuple[str, str] | None:
    """The text selected with the mouse: what the rows show, with wrapped lines joined."""
    ids = [index.shown[0].id, index.shown[-1].id] if index.shown else [0, -1]
    first = ids[0] if selection.start is None else selection.start.y
    last = ids[1] if selection.end is None else selection.end.y
    lines = []
    for entry in index.shown[index.place_of(first) : index.place_of(last + 1)]:
        span = selection.get_span(entry.id)
        if span is not None:
            text = "".join(gutter_texts(entry, columns)) + index.text_of(entry)
            lines.append(text[span[0] : len(text) if span[1] < 0 else span[1]])
    return ("\n".join(lines), "\n") if lines else None


PALETTE_CLASSES = {f"log--{part}" for part in ("muted", "marker", "found", "cursor", *map(str.lower, WORDS))}
PALETTE_CSS = """
    .log--muted { color: $foreground 60%; }
    .log--marker { color: $text-warning; text-style: italic; }
    .log--found { background: $warning; color: auto 90%; text-style: bold; }
    .log--cursor { background: $primary 35%; }
    .log--debug { color: $foreground 60%; }
    .log--info { color: $foreground; }
    .log--warn { color: $text-warning; text-style: bold; }
    .log--error { color: $text-error; text-style: bold; }
    .log--fatal { background: $error; color: auto 90%; text-style: bold; }
"""


PAGES_KEPT = 2
"""Drawn rows that are kept, in heights of the view: a row takes two kilobytes."""


class RowPainter:
    """Draws rows at one width, in one theme.

    Every character carries its position for the mouse: the entry's id, and how many characters of
    `gutter + text` come before it. So a selection stays with its lines whatever moves them.
    """

    def __init__(self, widget: Widget, index: LogIndex, columns: LogColumns, width: int, shift: int) -> None:
        """Use the colours of `widget`; `width` and `shift` are cells of the text, which is shifted if unwrapped."""

        def part(name: str) -> Style:
            return widget.get_component_rich_style(f"log--{name}", partial=False)

        self._index, self._columns, self._width, self._shift = index, columns, width, shift
        self._console = widget.app.console
        self._base = widget.rich_style
        self._muted, self._marker, self._found = part("muted"), part("marker"), part("found")
        self._severities = tuple(part(word.lower()) for word in WORDS)
        self._cursor = Style(bgcolor=part("cursor").bgcolor)
        self._selection = widget.screen.get_component_rich_style("screen--selection")
        lightness = 0.72 if widget.app.current_theme.dark else 0.34
        hues = (Color.from_hsl(hue / 360, 0.55, lightness).rich_color for hue in _HUES)
        self._nodes = tuple(self._base + Style(color=hue) for hue in hues)

        self._strips: LRUCache[tuple[int, int], Strip] = LRUCache(max(1, PAGES_KEPT * widget.container_size.height))
        self._across = widget.size.width

    def strip(self, entry: LogEntry, part: int, place: int, selection: Selection | None, *, chosen: bool) -> Strip:
        """One row in the width of the widget, drawn anew only while text is selected."""
        strip = None if selection else self._strips.get((entry.id, part))
        if strip is None:
            strip = self.row(entry, part, place, selection, chosen=chosen)
            strip = strip.adjust_cell_length(self._across, self._base)
            if selection is None:
                self._strips[entry.id, part] = strip
        return strip

    def row(self, entry: LogEntry, part: int, place: int, selection: Selection | None, *, chosen: bool) -> Strip:
        """Row number `part` of an entry, whose node has this `place` among the colours."""
        under = self._cursor if chosen else Style()
        text = self._index.text_of(entry)
        line, lead = self._line(entry, text, self._nodes[place % len(self._nodes)], under)
        pattern = self._index.filter.pattern
        for match in pattern.finditer(text) if pattern and not entry.skipped else ():
            line.stylize(self._found, lead + match.start(), lead + match.end())
        selected = selection.get_span(entry.id) if selection else None
        if selected is not None:
            line.stylize(self._selection, selected[0], len(line) if selected[1] < 0 else selected[1])
        start, end, more = self._piece(text, part)
        gutter = line[:lead]
        if part:
            blank = (CHOSEN if chosen else " ").ljust(self._columns.gutter)
            gutter = Text.assemble((blank, self._muted + under))
        elif chosen:
            gutter = Text.assemble((CHOSEN, gutter.get_style_at_offset(self._console, 0)), gutter[1:])
        strips = [self._strip(gutter), self._strip(line[lead + start : lead + end])]
        if not part:
            strips[0] = strips[0].apply_offsets(0, entry.id)
        strips[1] = strips[1].apply_offsets(lead + start, entry.id)
        if more:
            strips.append(self._strip(Text.assemble((MORE, self._muted + under))))
        return Strip.join(strips).extend_cell_length(self._columns.gutter + self._width, self._base + under)

    def _line(self, entry: LogEntry, text: str, node_style: Style, under: Style) -> tuple[Text, int]:
        """Columns and text of an entry, and how many characters the columns have."""
        when, word, node = gutter_texts(entry, self._columns)
        muted, alarm = self._muted + under, entry.rank > Severity.INFO.rank and not entry.skipped
        severity = self._severities[entry.rank] + under if alarm else muted
        style = self._base
        if entry.skipped:
            style = self._marker
        elif entry.rank == Severity.DEBUG.rank:
            style = self._muted
        elif alarm and not self._columns.word:
            style = severity
        said = [(when, muted), (word[:-1], severity), (word[-1:], muted)] if alarm else [(when + word, muted)]
        line = Text.assemble(*said, (node, node_style + under), (text, style + under))
        return line, len(when) + len(word) + len(node)

    def _strip(self, text: Text) -> Strip:
        # Of a text without spans, `render` leaves out the style.
        return Strip(segment for segment in text.render(self._console) if segment.text)

    def _piece(self, text: str, part: int) -> tuple[int, int, bool]:
        """Where the row's piece of the text begins and ends, and whether more is cut off."""
        if self._index.fold_width is not None:
            pieces = folded(text, self._width)
            part = min(part, len(pieces) - 1)
            start = sum(map(len, pieces[:part]))
            return start, start + len(pieces[part]), False
        more = cell_len(text) > self._shift + self._width
        last = self._shift + self._width - more
        if text.isascii():
            return self._shift, last, more
        return len(set_cell_size(text, self._shift)), len(set_cell_size(text, last)), more

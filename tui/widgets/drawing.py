"""A panel drawn from values: only cells that have changed are redrawn.

It shows why there is nothing to draw, and greys out values that are no longer current.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import ClassVar, NamedTuple

from rich.cells import cell_len, set_cell_size
from rich.segment import Segment
from rich.style import Style
from textual.geometry import Region, Size
from textual.strip import Strip
from textual.widget import Widget

from graph.data import Trouble
from text.i18n import _
from text.plain import plain
from tui.faults import report_fault
from tui.widgets.trouble import no_data_words, trouble_words
from tui.widgets.words import OneStyle, cut, word_strips

_ONE_CELL_EACH = re.compile("[ -~\u0400-\u0482\u2500-\u25ff\u2800-\u28ff]*")
"""Text whose characters need not be measured individually."""
LOOKS = ("muted", "good", "warn", "bad", "stop", "accent", "second", "strong", "alert")


class Ink(NamedTuple):
    """A text and its look: one of `LOOKS`, or plain. Only `alert` is not greyed out when stale."""

    text: str
    look: str = ""


Line = list[Ink]


class Placeholder(NamedTuple):
    """Words in place of values, when messages arrive but do not contain them."""

    headline: str
    detail: str


class Drawing(OneStyle, Widget):
    """Base of panels: a subclass draws lines of `Ink` and calls `redraw` when its values change."""

    ALLOW_SELECT = False
    COMPONENT_CLASSES: ClassVar[set[str]] = {f"drawing--{look}" for look in LOOKS}
    DEFAULT_CSS = """
    Drawing {
        height: 1fr;
        width: 1fr;
        min-height: 1;
        .drawing--muted { color: $foreground 55%; }
        .drawing--good { color: $text-success; text-style: bold; }
        .drawing--warn { color: $text-warning; text-style: bold; }
        .drawing--bad { color: $text-error; text-style: bold; }
        .drawing--stop { background: $error; color: auto 90%; text-style: bold; }
        .drawing--accent { color: $text-accent; text-style: bold; }
        .drawing--second { color: $text-primary; text-style: bold; }
        .drawing--strong { text-style: bold; }
        .drawing--alert { color: $text-warning; text-style: bold; }
    }
    """

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self._lines: list[Line] = []
        self._trouble: Trouble | None = None
        self._detail = ""
        self._age_s: float | None = None
        self._placeholder: Placeholder | None = None
        self._styles: dict[str, Style] = {}
        self._drawn_in = Size(0, 0)
        self._fault = ""
        """Why the values cannot be drawn, empty if they can."""

    @property
    def has_value(self) -> bool:
        raise NotImplementedError

    def draw(self, width: int, height: int) -> list[Line]:
        """Draw the values into this many cells; missing lines stay blank."""
        raise NotImplementedError

    def show_trouble(self, trouble: Trouble | None, detail: str = "", age_s: float | None = None) -> None:
        """Say why nothing arrives (None: all is well), and the age of the newest message."""
        # An age that is not shown is no reason to redraw.
        state = (trouble, detail, None if trouble is None else age_s)
        if state != (self._trouble, self._detail, self._age_s):
            self._trouble, self._detail, self._age_s = state
            self.redraw()

    def show_placeholder(self, words: Placeholder | None) -> None:
        """Show these words in place of outdated values; if empty, show values again."""
        if words != self._placeholder:
            self._placeholder = words
            self.redraw()

    @property
    def draws(self) -> bool:
        """Whether values are drawn, rather than words in place of them."""
        return self.has_value and self._placeholder is None

    @property
    def stale(self) -> bool:
        """Whether the values drawn are no longer current."""
        return self._trouble is not None and self.has_value

    @property
    def stale_words(self) -> str:
        """For how long nothing has arrived, or why; empty while all is well."""
        if self._trouble is None:
            return ""
        if self._age_s is not None:
            return no_data_words(self._age_s)
        return trouble_words(self._trouble)

    def redraw(self) -> None:
        width, height = self.size
        if not self.is_mounted or width < 1 or height < 1:
            return
        had, self._lines = self._lines, self._drawn(width, height)
        if not had or not self._lines:
            # There were words in place of values, or will be.
            self.refresh()
            return
        regions = [
            region
            for y in range(height)
            if (region := _difference(_at(had, y), _at(self._lines, y), y, width)) is not None
        ]
        if regions:
            self.refresh(*regions)

    def _drawn(self, width: int, height: int) -> list[Line]:
        self._drawn_in = Size(width, height)
        self._fault = ""
        if not self.draws:
            return []
        try:
            lines = self.draw(width, height)[:height]
        except Exception as error:  # noqa: BLE001 - raised again where faults are not isolated
            self._fault = report_fault(self, error)
            return []
        if self.stale:
            return [[ink if ink.look == "alert" else Ink(ink.text, "muted") for ink in line] for line in lines]
        return lines

    def on_resize(self) -> None:
        width, height = self.size
        self._lines = self._drawn(width, height) if width and height else []
        self.refresh()

    def on_language_changed(self) -> None:
        self.on_resize()

    def on_graphics_changed(self) -> None:
        self.on_resize()

    def render_lines(self, crop: Region) -> list[Strip]:
        """Some lines, with styles computed once for all of them: Textual takes 0.2 ms for one.

        Also handles a new size, which Textual does not always report if several layouts coincide.
        """
        self._styles.clear()
        if self._drawn_in != self.size:
            self.on_resize()
        return super().render_lines(crop)

    def render_line(self, y: int) -> Strip:
        width = self.size.width
        if self._fault or not self.draws:
            return self._words(y, width)
        segments = [Segment(ink.text, self.style_of(ink.look)) for ink in _at(self._lines, y)]
        return Strip(segments).adjust_cell_length(width, self.style_of(""))

    def style_of(self, look: str) -> Style:
        style = self._styles.get(look)
        if style is None:
            style = self.get_component_rich_style(f"drawing--{look}") if look else self.rich_style
            self._styles[look] = style
        return style

    def _words(self, y: int, width: int) -> Strip:
        headline = _("waiting for the first message")
        if self._trouble is not None:
            headline = trouble_words(self._trouble, self._age_s)
        words = (headline, plain(self._detail, 400))
        if self._placeholder is not None and self._trouble is None:
            words = self._placeholder
        if self._fault:
            words = (self._fault, "")
        strips = word_strips(words, width, self.rich_style, self.app.console, centred=True)
        height = self.size.height
        if y == height - 1 and len(strips) > height:
            return cut([*strips[y], Segment(" ")], width, self.rich_style)
        line = y - max(0, (height - len(strips)) // 2)
        blank = Strip.blank(width, self.rich_style)
        return strips[line] if 0 <= line < len(strips) else blank


def _at(lines: Sequence[Line], y: int) -> Line:
    return lines[y] if y < len(lines) else []


def _difference(before: Line, after: Line, y: int, width: int) -> Region | None:
    """The cells of a line that look different, from the first to the last of them."""
    if before == after:
        return None
    old, new = _cells(before, width), _cells(after, width)
    differ = [x for x in range(width) if old[x] != new[x]]
    return Region(differ[0], y, differ[-1] - differ[0] + 1, 1) if differ else None


def _cells(line: Line, width: int) -> list[tuple[str, str]]:
    """(character, look) of each cell; the second cell of a wide character is empty."""
    cells: list[tuple[str, str]] = []
    for text, look in line:
        if _ONE_CELL_EACH.fullmatch(text):
            cells.extend([(char, look) for char in text])
            continue
        for char in text:
            cells.append((char, look))
            cells.extend([("", look)] * (cell_len(char) - 1))
    cells.extend([(" ", "")] * (width - len(cells)))
    return cells


def cells_of(line: Line) -> int:
    return sum(cell_len(ink.text) for ink in line)


def fit(text: str, width: int) -> str:
    """The text in exactly `width` cells, with an ellipsis at the end if it was cut."""
    if cell_len(text) > width > 0:
        return set_cell_size(text, width - 1) + "…"
    return set_cell_size(text, max(0, width))


def beside(left: Line, right: Line, width: int) -> Line:
    """Two texts at the two ends of a line; the left one is cut if there is not enough room."""
    taken = cells_of(right)
    room = max(0, width - taken - 1)
    line: Line = []
    for ink in left:
        cells = cell_len(ink.text)
        if cells > room:
            line.append(Ink(fit(ink.text, room), ink.look))
            room = 0
            break
        line.append(ink)
        room -= cells
    return [*line, Ink(" " * (room + (1 if taken < width else 0))), *right]

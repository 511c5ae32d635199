"""The trail of a sent message as lines: delay, kind, topic and text."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.segment import Segment
from rich.style import Style
from rich.text import Text
from textual.geometry import Size
from textual.scroll_view import ScrollView
from textual.strip import Strip

from text.figures import whole
from text.i18n import _

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tui.outcome.trail import OutcomeEntry

DELAY, MARK, TOPIC = 8, 3, 18
"""Cells for the delay, for the mark between its blanks, and for the name of the topic."""
ROOMY = 64
"""Width from which on the text has a column of its own."""
KINDS = {"✓": "good", "✗": "bad", "!": "held", "→": "passed", "·": "awaited"}
SECOND_MS = 1000


class Outcome(ScrollView, can_focus=True):
    """Shows a headline and below it the entries, with long ones wrapped."""

    ALLOW_SELECT = False
    COMPONENT_CLASSES: ClassVar[set[str]] = {f"outcome--{kind}" for kind in KINDS.values()}
    DEFAULT_CSS = """
    Outcome {
        width: 1fr; height: 1fr; overflow-x: hidden; scrollbar-size-vertical: 1;
        &> .outcome--good { color: $text-success; }
        &> .outcome--bad { color: $text-error; text-style: bold; }
        &> .outcome--held { color: $text-warning; text-style: bold; }
        &> .outcome--passed { color: $text-primary; }
        &> .outcome--awaited { color: $foreground; text-style: dim; }
    }
    """

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._headline = ""
        self._entries: tuple[OutcomeEntry, ...] = ()
        self._strips: list[Strip] = []
        self._off_colour = False
        """Whether the strips still have the colours of the previous theme."""

    def show(self, headline: str, entries: Sequence[OutcomeEntry]) -> None:
        """Show these entries; redraws only if something has changed."""
        shown = (headline, tuple(entries))
        if shown != (self._headline, self._entries):
            self._headline, self._entries = shown
            self._draw()

    @property
    def headline(self) -> str:
        """The line above the entries."""
        return self._headline

    @property
    def entries(self) -> tuple[OutcomeEntry, ...]:
        return self._entries

    def render_line(self, y: int) -> Strip:
        if self._off_colour:
            self._lay()
        index, width = y + self.scroll_offset.y, self.size.width
        if index >= len(self._strips):
            return Strip.blank(width, self.rich_style)
        return self._strips[index].adjust_cell_length(width, self.rich_style)

    def on_resize(self) -> None:
        """Wrap to the new width."""
        self._draw()

    def notify_style_update(self) -> None:
        """Redraw in the colours of the new theme; component styles change after this call."""
        super().notify_style_update()
        self._off_colour = True
        self.refresh()

    def watch_show_vertical_scrollbar(self) -> None:
        """Wrap to the width that the scroll bar leaves."""
        self._draw()

    def _draw(self) -> None:
        self._lay()
        self.virtual_size = Size(0, len(self._strips))
        self.refresh()

    def _lay(self) -> None:
        self._off_colour = False
        base, width = self.rich_style, max(1, self.scrollable_size.width)
        self._strips = []
        if self._headline:
            self._wrap([], 0, self._headline, base + Style(bold=True), width)
        for entry in self._entries:
            self._entry(entry, width)

    def _entry(self, entry: OutcomeEntry, width: int) -> None:
        base = self.rich_style
        dim = base + Style(dim=True)
        kind = base + self.get_component_rich_style(f"outcome--{KINDS[entry.mark]}", partial=True)
        before = [Segment(delay_text(entry.delay_s).rjust(DELAY), dim), Segment(f" {entry.mark} ", kind)]
        if width < ROOMY:
            self._wrap(before, DELAY + MARK, f"{entry.topic}: {entry.text}", kind, width)
            return
        before.append(Segment(entry.topic.ljust(TOPIC), dim))
        self._wrap(before, DELAY + MARK + TOPIC, entry.text, kind, width)

    def _wrap(self, before: list[Segment], indent: int, text: str, style: Style, width: int) -> None:
        """Append the text to `before`, with its further lines indented."""
        lines = Text(text).wrap(self.app.console, max(8, width - indent))
        for number, line in enumerate(lines or [Text("")]):
            margin = before if number == 0 else [Segment(" " * indent, self.rich_style)]
            self._strips.append(Strip([*margin, Segment(line.plain, style)]))


def delay_text(delay_s: float | None) -> str:
    """Return a delay, in milliseconds if it is short."""
    if delay_s is None:
        return "…"
    milliseconds = delay_s * SECOND_MS
    if abs(milliseconds) < 10 * SECOND_MS:
        return _("{n} ms").format(n=whole(milliseconds))
    return _("{n} s").format(n=whole(delay_s))

"""The trail of a sent message as lines: delay, kind, topic and text."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.console import Group
from rich.style import Style
from rich.table import Table
from rich.text import Text
from textual.containers import VerticalScroll
from textual.widgets import Static

from text.figures import whole
from text.i18n import _

if TYPE_CHECKING:
    from collections.abc import Sequence

    from textual.app import ComposeResult

    from tui.outcome.trail import OutcomeEntry

DELAY, MARK, TOPIC = 8, 3, 18
"""Cells for the delay, for the mark between its blanks, and for the name of the topic."""
ROOMY = 64
"""Width from which on the text has a column of its own."""
KINDS = {"✓": "good", "✗": "bad", "!": "held", "→": "passed", "·": "awaited"}
SECOND_MS = 1000


class Outcome(VerticalScroll, can_focus=True):
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

    def __init__(self) -> None:
        super().__init__()
        self.headline = ""
        """The line above the entries."""
        self.entries: tuple[OutcomeEntry, ...] = ()

    def compose(self) -> ComposeResult:
        yield Static(markup=False)

    def show(self, headline: str, entries: Sequence[OutcomeEntry]) -> None:
        """Show these entries; redraws only if something has changed."""
        shown = (headline, tuple(entries))
        if shown != (self.headline, self.entries):
            self.headline, self.entries = shown
            self._draw()

    def on_resize(self) -> None:
        self._draw()

    def notify_style_update(self) -> None:
        """Redraw in the colours of the new theme; component styles change after this call."""
        super().notify_style_update()
        self.call_after_refresh(self._draw)

    def _draw(self) -> None:
        if not self.is_attached or not self.children:
            return
        dim, roomy = Style(dim=True), self.scrollable_size.width >= ROOMY
        lines = Table.grid()
        for width in (DELAY, MARK, TOPIC) if roomy else (DELAY, MARK):
            lines.add_column(width=width)
        lines.add_column(ratio=1)
        for entry in self.entries:
            kind = self.get_component_rich_style(f"outcome--{KINDS[entry.mark]}", partial=True)
            before = [Text(delay_text(entry.delay_s).rjust(DELAY), dim), Text(f" {entry.mark} ", kind)]
            if roomy:
                lines.add_row(*before, Text(entry.topic, dim), Text(entry.text, kind))
            else:
                lines.add_row(*before, Text(f"{entry.topic}: {entry.text}", kind))
        self.query_one(Static).update(Group(Text(self.headline, Style(bold=True)), lines))


def delay_text(delay_s: float | None) -> str:
    """Return a delay, in milliseconds if it is short."""
    if delay_s is None:
        return "…"
    milliseconds = delay_s * SECOND_MS
    if abs(milliseconds) < 10 * SECOND_MS:
        return _("{n} ms").format(n=whole(milliseconds))
    return _("{n} s").format(n=whole(delay_s))

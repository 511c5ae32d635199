"""Frames of a serial port in a log view: the time to a millisecond, which way, what they say."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any, ClassVar

from rich.segment import Segment
from textual.strip import Strip

from text.i18n import _
from tui.devices.frame_rows import WAYS
from tui.log_view.pane import LogPane
from tui.log_view.rows import Columns
from tui.log_view.view import LogView

if TYPE_CHECKING:
    from collections.abc import Sequence

    from launcher.status import LogLine

_WAY_CELLS = 6


class FramesView(LogView):
    """Has no column for the severity: what is no good frame is marked in its text."""

    def __init__(self, **more: Any) -> None:  # noqa: ANN401 - as for `LogView`
        super().__init__(**more, fold=False)

    def columns_for(self, width: int, longest_node: int) -> Columns:
        """Time and way; short ones on a narrow screen."""
        del longest_node
        return Columns(12 if width >= 60 else 8, 0, _WAY_CELLS)

    def replace_lines(self, lines: Sequence[LogLine]) -> None:
        """Show these lines in place of all others; a paused view stays paused."""
        following = self.following
        self.clear()
        self.append(lines)
        if not following:
            self.pause()

    def _words_line(self, y: int) -> Strip:
        if self.ring.entries:
            return super()._words_line(y)
        words = textwrap.wrap(self.empty_words, max(1, self.size.width - 2))
        style = self.get_component_rich_style("log--muted")
        strip = Strip([Segment(f" {words[y]}", style)]) if y < len(words) else Strip([])
        return strip.adjust_cell_length(self.size.width, self.rich_style)


class FramesPane(LogPane):
    """The frames with all that can be done to lines of a log."""

    view_type: ClassVar[type[LogView]] = FramesView

    def on_mount(self) -> None:
        """Say things in the language spoken now."""
        self.words_changed()

    def words_changed(self) -> None:
        """Draw anew in another language."""
        self.view.minimum_words = _("only noise and bad frames")
        self.view.know_nodes(_(way) for way in WAYS.values())
        super().words_changed()

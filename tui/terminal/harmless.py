"""The last check of what goes to the terminal: no control sequences in the text of widgets.

Widgets that show text from outside make it harmless themselves, so that it is measured as it is
shown. This catches what was overlooked, and what is typed or pasted into Textual's own fields.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.cells import set_cell_size
from rich.segment import Segment
from textual.filter import LineFilter

from text.plain import is_plain, plain
from tui.terminal.pixels import PICTURE

if TYPE_CHECKING:
    from textual.color import Color


class Harmless(LineFilter):
    """Replaces characters that must not be shown, without changing the width of the line."""

    def apply(self, segments: list[Segment], background: Color) -> list[Segment]:
        """Return the line, usually the same object."""
        del background
        if is_plain("".join([segment.text for segment in segments])):
            return segments
        return [_harmless(segment) for segment in segments]


def _harmless(segment: Segment) -> Segment:
    if PICTURE.fullmatch(segment.text):
        # No terminal gets it, see `terminal_diff`.
        return segment
    text = plain(segment.text)
    if segment.control or text == segment.text:
        return segment
    return Segment(set_cell_size(text, segment.cell_length), segment.style)

"""The last look at what goes to the terminal: no control sequence of a widget's text gets through.

Who shows text from outside makes it plain, so that it is seen and measured as it is shown. What
somebody forgot, and what is typed or pasted into a field of Textual's own, is found here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.cells import set_cell_size
from rich.segment import Segment
from textual.filter import LineFilter

from text.plain import is_plain, plain

if TYPE_CHECKING:
    from textual.color import Color


class Harmless(LineFilter):
    """Replaces what must not be shown in a line, which stays as wide as it was."""

    def apply(self, segments: list[Segment], background: Color) -> list[Segment]:
        """Return the line, as a rule the very same one."""
        del background
        if is_plain("".join([segment.text for segment in segments])):
            return segments
        return [_harmless(segment) for segment in segments]


def _harmless(segment: Segment) -> Segment:
    text = plain(segment.text)
    if segment.control or text == segment.text:
        return segment
    return Segment(set_cell_size(text, segment.cell_length), segment.style)

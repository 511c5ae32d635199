"""A line to type into that never holds what it does not show."""

from __future__ import annotations

from textual.reactive import reactive
from textual.widgets import Input

from text.plain import plain


class Field(Input):
    """An `Input` whose value is what stands there, typed, pasted or set: that is what is sent.

    A value that is more than plain text has to be put there, and read, in a form that is plain.
    """

    # A blink is bytes over the line twice a second, for as long as somebody thinks.
    cursor_blink = reactive(False, init=False)

    def validate_value(self, value: str) -> str:
        """Make visible what would be hidden, or obeyed by the terminal."""
        return plain(value)

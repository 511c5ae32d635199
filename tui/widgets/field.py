"""A line to type into that never holds what it does not show."""

from __future__ import annotations

from textual.widgets import Input

from text.plain import plain


class Field(Input):
    """An `Input` whose value is what stands there, typed, pasted or set: that is what is sent.

    A value that is more than plain text has to be put there, and read, in a form that is plain.
    """

    def validate_value(self, value: str) -> str:
        """Make visible what would be hidden, or obeyed by the terminal."""
        return plain(value)

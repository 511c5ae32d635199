"""An input line that never contains anything it does not show."""

from __future__ import annotations

from textual.reactive import reactive
from textual.widgets import Input

from text.plain import plain


class Field(Input):
    """An `Input` whose value is exactly what it shows, whether typed, pasted or set.

    A value that is more than plain text has to be set, and read, in an escaped form.
    """

    # A blinking cursor would send bytes twice a second for as long as the user thinks.
    cursor_blink = reactive(False, init=False)

    def validate_value(self, value: str) -> str:
        """Escape what would be invisible, or interpreted by the terminal."""
        return plain(value)

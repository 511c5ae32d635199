"""A text field for the JSON that an LLM would send."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from robot.limits import MAX_BYTES
from tui.composer.json_tokens import tokens
from tui.widgets.marked_editor import MarkedEditor

if TYPE_CHECKING:
    from collections.abc import Iterable

    from tui.widgets.marked_editor import Token


class JsonEditor(MarkedEditor):
    """Edits JSON, no more of it than the robot takes."""

    longest: ClassVar[int] = MAX_BYTES

    def tokens_of(self, line: str) -> Iterable[Token]:
        """Return the tokens of JSON."""
        return tokens(line)

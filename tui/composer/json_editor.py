"""A text field for the JSON that an LLM would send, with syntax colours."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, ClassVar

from textual.document._history import EditHistory

from robot.limits import MAX_BYTES
from tui.widgets.marked_editor import MarkedEditor, Token

if TYPE_CHECKING:
    from collections.abc import Iterable

    from tui.widgets.marked_editor import Token

_TOKEN = re.compile(
    r"""
    (?P<string>"(?:[^"\\]|\\.)*(?P<closed>"?))
    | (?P<number>-?\d[\w.+-]*)
    | (?P<word>[^\W\d]\w*)
    | (?P<mark>[{}\[\],:])
    | (?P<other>\S)
    """,
    re.VERBOSE,
)
_KEY_FOLLOWS = re.compile(r"\s*:")
_NUMBER = re.compile(r"-?(0|[1-9]\d*)(\.\d+)?([eE][+-]?\d+)?")
_WORDS = frozenset({"true", "false", "null"})


def tokens(line: str) -> Iterator[Token]:
    """Yield the tokens of a line in order; accepts any text."""
    for match in _TOKEN.finditer(line):
        yield Token(match.start(), match.end(), _kind(match, line))


def _kind(match: re.Match[str], line: str) -> str:
    kind, text = match.lastgroup, match.group()
    if match.group("string") is not None:
        if not match.group("closed"):
            return "bad"
        return "key" if _KEY_FOLLOWS.match(line, match.end()) else "string"
    if kind == "number":
        return "number" if _NUMBER.fullmatch(text) else "bad"
    if kind == "word":
        return "word" if text in _WORDS else "bad"
    return "mark" if kind == "mark" else "bad"


class JsonEditor(MarkedEditor):
    """Edits JSON, no longer than the robot accepts."""

    longest: ClassVar[int] = MAX_BYTES
    _before: tuple[str, EditHistory] | None = None
    """The text, and how to undo it, that an answer under way has replaced."""

    def tokens_of(self, line: str) -> Iterable[Token]:
        return tokens(line)

    # ---------------------------------------------------------------- an answer that comes

    def begin_growing(self) -> None:
        """Show an answer as it comes, in place of the text, which nobody can edit meanwhile."""
        self._before = self.text, self.history
        # What comes piece by piece is taken back as a whole.
        self.history = EditHistory(1, 0.0, 0)
        self.read_only = True
        self.show_problems(())
        self.grow_to("")

    def grow_to(self, text: str) -> None:
        shown, now = self.shown(text), self.text
        if shown == now:
            return
        if shown.startswith(now):
            self.insert(shown[len(now) :], self.document.end)
        else:
            self.replace(shown, self.document.start, self.document.end)
        self.move_cursor(self.document.end)

    def end_growing(self, text: str | None) -> None:
        """Show the whole answer, which can be undone; with None the text from before."""
        if self._before is None:
            return
        before, history = self._before
        self._before = None
        self.replace_all(before)
        self.history = history
        self.read_only = False
        if text is not None and self.shown(text) != before:
            self.history.checkpoint()
            self.replace_all(text)
            self.history.checkpoint()

"""A text field for the JSON that an LLM would send, with syntax colours."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, ClassVar

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

    def tokens_of(self, line: str) -> Iterable[Token]:
        """Return the tokens of JSON."""
        return tokens(line)

"""The tokens of a line of JSON, for colouring it and for underlining one that is wrong.

A JSON text has no token that spans two lines, so a line is read alone: no parser has to be kept
in step with the editor.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

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
    """Yield the tokens of a line in order; never fails, whatever the line is."""
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

"""A text field for a message as YAML."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from text.yaml_scalars import escaped, meaning
from tui.widgets.marked_editor import MarkedEditor, Token


class YamlEditor(MarkedEditor):
    """Edits YAML; Enter starts a new line with the indentation of the current one."""

    def escaped(self, character: str) -> str:
        return escaped(character)

    def tokens_of(self, line: str) -> Iterable[Token]:
        return tokens(line)


_TOKEN = re.compile(
    r"""
    (?P<comment>(?:^|(?<=\s))\#.*)
    | (?P<string>"(?:[^"\\]|\\.)*"? | '(?:[^']|'')*'?)
    | (?P<mark>[\[\]{},] | [-:](?=\s|$))
    | (?P<plain>(?:[^\s\[\]{},:] | :(?!\s|$))+)
    """,
    re.VERBOSE,
)
_KEY_FOLLOWS = re.compile(r"\s*:(?=\s|$)")


def tokens(line: str) -> Iterator[Token]:
    """Yield the tokens of a line in order; accepts any text."""
    for match in _TOKEN.finditer(line):
        yield Token(match.start(), match.end(), _kind(match, line))


def _kind(match: re.Match[str], line: str) -> str:
    kind = match.lastgroup or "plain"
    if kind in {"comment", "mark"}:
        return kind
    if _KEY_FOLLOWS.match(line, match.end()):
        return "key"
    if kind == "string":
        return kind
    value = meaning(match.group())
    if isinstance(value, str):
        return "string"
    return "word" if value is None or isinstance(value, bool) else "number"

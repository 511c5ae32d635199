"""What is wrong with a YAML text, in words that help whoever typed it: PyYAML's are for its makers.

English, marked for the catalogue of the screen; a room makes sentences of its own of them.
"""

from __future__ import annotations

from dataclasses import dataclass

import yaml

from text.i18n import N_


@dataclass(frozen=True)
class Fault:
    """What is wrong at a place, counted from 1."""

    line: int
    column: int
    words: str
    """Empty where PyYAML's words are not known."""


_LIST = N_("this list is not closed: a ',' or a ']' is missing")
_BRACES = N_("these braces are not closed: a ',' or a '}' is missing")
_INDENT = N_("the indentation does not fit the lines above")
_NO_VALUE = N_("a value is missing here, or a ']' or '}'")
_BEGUN_BEFORE = {
    "could not find expected ':'": N_(
        "a ':' is missing after the name of the field, or a space after it"
    ),
    "did not find expected ',' or ']'": _LIST,
    "expected ',' or ']'": _LIST,
    "did not find expected ',' or '}'": _BRACES,
    "expected ',' or '}'": _BRACES,
    "found unexpected end of stream": N_("the text in quotes is not closed"),
}
"""How PyYAML's own words begin (of both its parsers), and what is meant; told of where it began."""
_WORDS = {
    "found character that cannot start any token": N_(
        "nothing can begin with this character: put the text in quotes"
    ),
    "found unknown escape": N_("YAML does not know this \\ in double quotes: use single quotes"),
    "did not find expected key": _INDENT,
    "expected <block end>": _INDENT,
    "did not find expected node content": _NO_VALUE,
    "expected the node content": _NO_VALUE,
    "did not find expected '-' indicator": N_("the indentation does not fit the list above"),
    "block sequence entries are not allowed": N_(
        "a list cannot begin here: put it on a line of its own, or the '-' in quotes"
    ),
}
_COLON = "mapping values are not allowed"
_SECOND_COLON = N_("a second ':' in one line: put the text that holds it in quotes")
_NO_COLON = N_(
    "this line does not fit the one above: a ':' is missing there, or the indentation differs"
)


def fault_of(error: yaml.MarkedYAMLError, text: str) -> Fault:
    """Return where and what `error` finds wrong in `text`; it must have a mark."""
    mark = error.problem_mark
    assert mark is not None
    lines = text.split("\n")
    found = error.problem or str(error)
    meant = _meant(found, _BEGUN_BEFORE)
    if meant and error.context_mark:
        mark = error.context_mark
    place = _within(mark.line, mark.column, lines)
    if found.startswith(_COLON):
        content = lines[mark.line] if mark.line < len(lines) else ""
        meant = _SECOND_COLON if ":" in content[: mark.column] else _NO_COLON
    return Fault(*place, meant or _meant(found, _WORDS))


def _within(line: int, column: int, lines: list[str]) -> tuple[int, int]:
    """Return a place counted from 1; what is missed at the very end, at the last line's end."""
    while line > 0 and (line >= len(lines) or not lines[line].strip()):
        line -= 1
        column = len(lines[line].rstrip())
    return line + 1, column + 1


def _meant(words: str, known: dict[str, str]) -> str:
    return next((said for begin, said in known.items() if words.startswith(begin)), "")

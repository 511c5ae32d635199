"""What is wrong with a YAML text, in words that help whoever typed it."""

from __future__ import annotations

from typing import NoReturn

import yaml

from graph.words import Words, say

_LIST = say("this list is not closed: a ',' or a ']' is missing")
_BRACES = say("these braces are not closed: a ',' or a '}' is missing")
_INDENT = say("the indentation does not fit the lines above")
_NO_VALUE = say("a value is missing here, or a ']' or '}'")
_BEGUN_BEFORE = {
    "could not find expected ':'": say(
        "a ':' is missing after the name of the field, or a space after it"
    ),
    "did not find expected ',' or ']'": _LIST,
    "expected ',' or ']'": _LIST,
    "did not find expected ',' or '}'": _BRACES,
    "expected ',' or '}'": _BRACES,
    "found unexpected end of stream": say("the text in quotes is not closed"),
}
"""How PyYAML's own words begin (of both its parsers), and what is meant; told of where it began."""
_WORDS = {
    "found character that cannot start any token": say(
        "nothing can begin with this character: put the text in quotes"
    ),
    "did not find expected key": _INDENT,
    "expected <block end>": _INDENT,
    "did not find expected node content": _NO_VALUE,
    "expected the node content": _NO_VALUE,
    "did not find expected '-' indicator": say("the indentation does not fit the list above"),
    "block sequence entries are not allowed": say(
        "a list cannot begin here: put it on a line of its own, or the '-' in quotes"
    ),
}
_COLON = "mapping values are not allowed"
_SECOND_COLON = say("a second ':' in one line: put the text that holds it in quotes")
_NO_COLON = say(
    "this line does not fit the one above: a ':' is missing there, or the indentation differs"
)


class YamlError(ValueError):
    """A text is no YAML that could be a message; str() is `line:column: what is wrong`."""

    def __init__(self, line: int, column: int, message: str) -> None:
        """Say what is wrong at a place, counted from 1."""
        super().__init__(f"{line}:{column}: {message}")
        self.line = line
        self.column = column
        self.message = message
        """Made by `graph.words.say`, so that it can be translated."""


def tell_syntax(error: yaml.YAMLError, text: str) -> NoReturn:
    """Raise a YamlError for what PyYAML refuses."""
    if not isinstance(error, yaml.MarkedYAMLError) or error.problem_mark is None:
        _tell_unprintable(error, text)
    mark = error.problem_mark
    lines = text.split("\n")
    content = lines[mark.line] if mark.line < len(lines) else ""
    indent = content[: len(content) - len(content.lstrip())]
    if "\t" in indent:
        tab = say("this line is indented with a tab: use spaces, not tabs")
        raise YamlError(mark.line + 1, indent.index("\t") + 1, tab) from error
    words = getattr(error, "problem", None) or str(error)
    meant = _meant(words, _BEGUN_BEFORE)
    if meant and error.context_mark:
        mark = error.context_mark
    place = _within(mark.line, mark.column, lines)
    if words.startswith(_COLON):
        meant = _SECOND_COLON if ":" in content[: mark.column] else _NO_COLON
    meant = meant or _meant(words, _WORDS)
    if meant is None:
        raise YamlError(*place, say("not YAML: {reason}", reason=words)) from error
    raise YamlError(*place, meant) from error


def _within(line: int, column: int, lines: list[str]) -> tuple[int, int]:
    """Return a place counted from 1; what is missed at the very end, at the last line's end."""
    while line > 0 and (line >= len(lines) or not lines[line].strip()):
        line -= 1
        column = len(lines[line].rstrip())
    return line + 1, column + 1


def _meant(words: str, known: dict[str, Words]) -> Words | None:
    return next((said for begin, said in known.items() if words.startswith(begin)), None)


def tell_character(text: str, offset: int) -> NoReturn:
    """Raise a YamlError for a character that YAML does not allow."""
    before = text[:offset]
    line = before.count("\n") + 1
    column = offset - (before.rfind("\n") + 1) + 1
    code = f"{ord(text[offset]):04X}"
    raise YamlError(line, column, say("the character U+{code} is not allowed", code=code))


def _tell_unprintable(error: yaml.YAMLError, text: str) -> NoReturn:
    for offset, character in enumerate(text):
        if yaml.reader.Reader.NON_PRINTABLE.match(character):
            tell_character(text, offset)
    raise YamlError(1, 1, say("not YAML: {reason}", reason=str(error))) from error

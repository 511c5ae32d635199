"""What is wrong with a YAML text, in words that help whoever typed it: PyYAML's are for its makers.

`events` reads for every room: a profile, a message and a parameter are told the same of the same.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import yaml

from text.i18n import N_
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterator

    from text.sentences import Words
    from text.yaml_tree import FilePlace, Where


class YamlError(ValueError):
    """A text is not the YAML that was asked for; str() is `line:column: what is wrong`."""

    def __init__(self, line: int, column: int, message: str, where: Where = ()) -> None:
        """Say what is wrong at a place, counted from 1; `where` is the path of a wrong value."""
        super().__init__(f"{line}:{column}: {message}")
        self.line = line
        self.column = column
        self.message = message
        """Made by `text.sentences.say`, so that it can be translated."""
        self.where = where
        """A path such as `("nodes", "sonar_front")`, empty for a fault in the text itself."""


LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def fault(place: FilePlace, message: str, where: Where = ()) -> YamlError:
    """Return the error to raise for a place; `where` is the path of the value that is wrong."""
    return YamlError(place.line, place.column, message, where)


def events(text: str) -> Iterator[yaml.Event]:
    """Yield what stands in a text, piece by piece. Raises YamlError."""
    try:
        text.encode()
    except UnicodeEncodeError as error:
        raise character_error(text, error.start) from error
    try:
        yield from yaml.parse(text, Loader=LOADER)
    except yaml.YAMLError as error:
        raise _syntax_error(error, text) from error


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
    "exceeded maximum nesting depth": N_("is nested too deeply"),
    "found character that cannot start any token": N_(
        "nothing can begin with this character: put the text in quotes"
    ),
    "found unknown escape": N_("YAML does not know this \\ in double quotes: use single quotes"),
    "did not find expected key": _INDENT,
    "expected <block end>": _INDENT,
    "did not find expected node content": _NO_VALUE,
    "expected the node content": _NO_VALUE,
    "did not find expected '-' indicator": N_("the indentation does not fit the list above"),
    "found unexpected ':'": N_("a space is missing after this ':'"),
    "block sequence entries are not allowed": N_(
        "a list cannot begin here: put it on a line of its own, or the '-' in quotes"
    ),
}
_COLON = "mapping values are not allowed"
_SECOND_COLON = N_("a second ':' in one line: put the text that holds it in quotes")
_NO_COLON = N_(
    "this line does not fit the one above: a ':' is missing there, or the indentation differs"
)


_LIKE_SPACE = "\u00a0\u2000-\u200b\u202f\u205f\u2060\u3000\ufeff"
_SPACE_MEANT = re.compile(
    rf"^(?:-|[a-z][a-z0-9_]*:)?(?P<odd>[{_LIKE_SPACE}])|(?P<late>[{_LIKE_SPACE}])(?:$|#)"
)
"""Where only a space can be meant: at the ends, after a name's colon or a dash, before a `#`."""
_INDENTED = re.compile(rf"^ *[{_LIKE_SPACE}]")


def space_meant(word: str, *, is_name: bool) -> int | None:
    """Return where a text without quotes has what only looks like a space, None if it has none.

    Between two words of a value it may be meant; in a name it never is.
    """
    if is_name:
        found = re.search(rf"[{_LIKE_SPACE}]", word)
        return found.start() if found else None
    found = _SPACE_MEANT.search(word)
    return found.start(found.lastgroup or 0) if found else None


def not_a_space(line: int, column: int, character: str) -> YamlError:
    """Return that a character only looks like a space."""
    words = say(
        "the character U+{code} only looks like a space: write an ordinary one",
        code=f"{ord(character):04X}",
    )
    return YamlError(line, column, words)


LONGEST_VALUE = 30
"""Characters of a value that an error repeats."""
_WITHOUT_SPACE = re.compile(r"(?P<name>[A-Za-z]\w*):(?P<value>[^/\s][^\n]*)")
"""A name and its value in one word; not `http://`."""


def space_missing(text: str) -> Words | None:
    """Say where a space is missing in `x:0`, which is one word; None if it is something else."""
    found = _WITHOUT_SPACE.match(text)
    if found is None:
        return None
    name, value = found["name"], found["value"]
    value = value if len(value) <= LONGEST_VALUE else f"{value[:LONGEST_VALUE]}…"
    return say("a space is missing after the ':': {mended}", mended=f"{name}: {value}")


def character_error(text: str, offset: int) -> YamlError:
    """Return that YAML does not allow a character."""
    before = text[:offset]
    line = before.count("\n") + 1
    column = offset - (before.rfind("\n") + 1) + 1
    code = f"{ord(text[offset]):04X}"
    return YamlError(
        line, column, say("the character U+{code} is not allowed: remove it", code=code)
    )


def _syntax_error(error: yaml.YAMLError, text: str) -> YamlError:
    mark = getattr(error, "problem_mark", None)
    if not isinstance(error, yaml.MarkedYAMLError) or mark is None:
        for offset, character in enumerate(text):
            if yaml.reader.Reader.NON_PRINTABLE.match(character):
                return character_error(text, offset)
        return YamlError(1, 1, say("not YAML: {reason}", reason=str(error)))
    lines = text.split("\n")
    content = lines[mark.line] if mark.line < len(lines) else ""
    indent = content[: len(content) - len(content.lstrip())]
    if "\t" in indent:
        tab = say("this line is indented with a tab: use spaces, not tabs")
        return YamlError(mark.line + 1, indent.index("\t") + 1, tab)
    if odd := _INDENTED.match(content):
        return not_a_space(mark.line + 1, odd.end(), content[odd.end() - 1])
    found = error.problem or str(error)
    meant = _meant(found, _BEGUN_BEFORE)
    if meant and error.context_mark:
        mark = error.context_mark
    place = _within(mark.line, mark.column, lines)
    if found.startswith(_COLON):
        meant = _SECOND_COLON if ":" in content[: mark.column] else _NO_COLON
    meant = meant or _meant(found, _WORDS)
    reason = ", ".join(words for words in (error.problem, error.context) if words)
    return YamlError(*place, say(meant) if meant else say("not YAML: {reason}", reason=reason))


def _within(line: int, column: int, lines: list[str]) -> tuple[int, int]:
    """Return a place counted from 1; what is missed at the very end, at the last line's end."""
    while line > 0 and (line >= len(lines) or not lines[line].strip()):
        line -= 1
        column = len(lines[line].rstrip())
    return line + 1, column + 1


def _meant(words: str, known: dict[str, str]) -> str:
    return next((said for begin, said in known.items() if words.startswith(begin)), "")

"""What is wrong with a YAML text, in words that help whoever typed it: PyYAML's are for its makers.

`composed` reads for every room: the same fault gets the same message everywhere.
"""

from __future__ import annotations

import re
from typing import Any

import yaml

from text.i18n import N_
from text.sentences import Words, say

PLAIN = "plain"
"""The tag of a word without quotes; what it means, `text.yaml_scalars` knows."""
LONGEST_VALUE = 30
"""Characters of a value that an error repeats."""


class YamlError(ValueError):
    """A text is not the YAML that was asked for; str() is `line:column: what is wrong`."""

    def __init__(self, line: int, column: int, message: str, where: tuple[str | int, ...] = ()) -> None:
        """Say what is wrong at a place, counted from 1; `where` is the path of a wrong value."""
        super().__init__(f"{line}:{column}: {message}")
        self.line = line
        self.column = column
        self.message = message
        """Made by `text.sentences.say`, so that it can be translated."""
        self.where = where
        """A path such as `("nodes", "sonar_front")`, empty for a fault in the text itself."""


_SAFE_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class _Loader(_SAFE_LOADER):  # type: ignore[misc]
    """Makes nodes of a text, without deciding what a word without quotes means."""

    yaml_implicit_resolvers = {None: [(PLAIN, re.compile(""))]}  # noqa: RUF012 - as PyYAML has it


def composed(text: str, *, shares: bool) -> yaml.Node | None:
    """Return the only document of a text, None if there is none. Raises YamlError.

    `shares`: whether anchors and aliases are allowed.
    """
    try:
        text.encode()
    except UnicodeEncodeError as error:
        raise character_error(text, error.start) from error
    try:
        if not shares and ("&" in text or "*" in text):
            _refuse_anchors(text)
        return yaml.compose(text, Loader=_Loader)
    except yaml.YAMLError as error:
        raise _syntax_error(error, text) from error


def _refuse_anchors(text: str) -> None:
    for event in yaml.parse(text, Loader=_SAFE_LOADER):
        if getattr(event, "anchor", None) is not None and event.start_mark is not None:
            words = say("anchors and aliases are refused: write the value out")
            raise YamlError(event.start_mark.line + 1, event.start_mark.column + 1, words)


_LIST = N_("this list is not closed: a ',' or a ']' is missing")
_BRACES = N_("these braces are not closed: a ',' or a '}' is missing")
_INDENT = N_("the indentation does not fit the lines above")
_NO_VALUE = N_("a value is missing here, or a ']' or '}'")
_BEGUN_BEFORE = {
    "could not find expected ':'": N_("a ':' is missing after the name of the field, or a space after it"),
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
    "but found another document": N_("a second document begins here, and only one is read"),
    "found undefined alias": N_("this alias refers to nothing: there is no such anchor before it"),
    "second occurrence": N_("there is an anchor of this name already"),
}
_NO_COLON_FOUND = "could not find expected ':'"
_DASH = re.compile(r"\s*-[^\s-]")
_NO_SPACE = N_("a space is missing after this '-', or a ':' in this line")
_COLON = "mapping values are not allowed"
_SECOND_COLON = N_("a second ':' in one line: put the text that holds it in quotes")
_NO_COLON = N_("this line does not fit the one above: a ':' is missing there, or the indentation differs")

_LIKE_SPACE = "\u00a0\u1680\u2000-\u200a\u202f\u205f\u3000"
_ZERO_WIDTH = "\u00ad\u180e\u200b\u2060\ufeff"
_INVISIBLE = "\u061c\u115f\u1160\u200c-\u200f\u202a-\u202e\u2061-\u206f\u3164"
"""What may be meant in a text: joiners, directions, fillers."""
_ODD = f"{_LIKE_SPACE}{_ZERO_WIDTH}"
_SPACE_MEANT = re.compile(rf"^(?:-|[a-z][a-z0-9_]*:)?(?P<odd>[{_ODD}])|(?P<late>[{_ODD}])(?:$|#)")
"""Where only a space can be meant: at the ends, after a name's colon or a dash, before a `#`."""
_IN_NAME = re.compile(f"[{_ODD}{_INVISIBLE}]")
_HIDDEN = re.compile(f"[{_ZERO_WIDTH}{_INVISIBLE}]")
_NUMBER = re.compile(r"[-+.0-9][0-9.eE+-]*")
_INDENTED = re.compile(rf"^ *[{_ODD}]")
_WIDE = dict(zip("\uff1a\uff0c\uff5b\uff5d\uff3b\uff3d", ":,{}[]", strict=True))
"""What Chinese and Japanese keyboards write (full width), and what only YAML understands."""
_WIDE_COLON = re.compile("[A-Za-z][A-Za-z0-9_]* ?(?P<odd>\uff1a)")
_WIDE_MEANT = re.compile(f"(?<=[A-Za-z0-9_}}\\] ])[{''.join(_WIDE)}]")
_QUOTED = re.compile(r"\"[^\"]*\"|'[^']*'|(?<= )#.*")
_BREAKS = re.compile("\r\n|[\n\r\x85\u2028\u2029]")
"""What ends a line in YAML 1.1."""
_WITHOUT_SPACE = re.compile(r"(?P<name>[A-Za-z]\w*) ?:(?P<value>[^/\s][^\n]*)")
"""A name and its value in one word; not `http://`."""


def space_meant(word: str, *, is_name: bool) -> int | None:
    """Return where a text without quotes has a character that only seems to be another, or none.

    None: it has none. Between two words of a value it may be meant; in a name it never is.
    """
    if word.isascii():
        return None
    if is_name:
        found = _IN_NAME.search(word)
        return found.start() if found else wide_colon(word)
    hidden = _HIDDEN.search(word)
    if hidden is not None and _NUMBER.fullmatch(_HIDDEN.sub("", word)):
        return hidden.start()
    found = _SPACE_MEANT.search(word)
    return found.start(found.lastgroup or 0) if found else None


def wide_colon(text: str) -> int | None:
    """Return where a name has a full-width colon behind it, None if it has none."""
    found = _WIDE_COLON.match(text)
    return found.start("odd") if found else None


def space_missing(text: str) -> Words | None:
    """Say where a space is missing in `x:0`, which is one word; None if it is something else."""
    found = _WITHOUT_SPACE.match(text)
    if found is None:
        return None
    name, value = found["name"], found["value"]
    value = value if len(value) <= LONGEST_VALUE else f"{value[:LONGEST_VALUE]}…"
    return say("a space is missing after the ':': {mended}", mended=f"{name}: {value}")


def not_as_it_seems(line: int, column: int, character: str) -> YamlError:
    """Return that a character only looks like another one, or like nothing."""
    code = f"{ord(character):04X}"
    if character in _WIDE:
        words = say(
            "the character U+{code} only looks like '{sign}': write an ordinary one", code=code, sign=_WIDE[character]
        )
    elif _HIDDEN.fullmatch(character):
        words = say("the character U+{code} is invisible: remove it", code=code)
    else:
        words = say("the character U+{code} only looks like a space: write an ordinary one", code=code)
    return YamlError(line, column, words)


def character_error(text: str, offset: int) -> YamlError:
    """Return that YAML does not allow a character."""
    line, column = text.count("\n", 0, offset) + 1, offset - text.rfind("\n", 0, offset)
    code = f"{ord(text[offset]):04X}"
    return YamlError(line, column, say("the character U+{code} is not allowed: remove it", code=code))


def _syntax_error(error: yaml.YAMLError, text: str) -> YamlError:
    mark = getattr(error, "problem_mark", None)
    if not isinstance(error, yaml.MarkedYAMLError) or mark is None:
        odd = yaml.reader.Reader.NON_PRINTABLE.search(text)
        return character_error(text, odd.start()) if odd else YamlError(1, 1, _unknown(str(error)))
    lines = _BREAKS.split(text)
    content = lines[mark.line] if mark.line < len(lines) else ""
    seen = _unseen(mark.line + 1, content) or _hidden_break(text[: mark.index + 1])
    if seen is not None:
        return seen
    found = error.problem or str(error)
    meant = _meant(found, _BEGUN_BEFORE)
    if meant and error.context_mark:
        mark = error.context_mark
    place = _within(mark.line, mark.column, lines)
    if found.startswith(_COLON):
        meant = _SECOND_COLON if ":" in content[: mark.column] else _NO_COLON
    elif found.startswith(_NO_COLON_FOUND) and _DASH.match(lines[place[0] - 1]):
        meant = _NO_SPACE
    meant = meant or _meant(found, _WORDS)
    reason = ", ".join(words for words in (error.problem, error.context) if words)
    return YamlError(*place, say(meant) if meant else _unknown(reason))


def _unknown(reason: str) -> Words:
    return say("not YAML: {reason}", reason=reason)


def _unseen(line: int, content: str) -> YamlError | None:
    """Return which character of a line that cannot be read is not what it seems to be."""
    indent = content[: len(content) - len(content.lstrip())]
    if "\t" in indent:
        tab = say("this line is indented with a tab: use spaces, not tabs")
        return YamlError(line, indent.index("\t") + 1, tab)
    if odd := _INDENTED.match(content):
        return not_as_it_seems(line, odd.end(), content[odd.end() - 1])
    if wide := _WIDE_MEANT.search(_QUOTED.sub(lambda found: " " * len(found[0]), content)):
        return not_as_it_seems(line, wide.start() + 1, wide[0])
    return None


def _hidden_break(before: str) -> YamlError | None:
    """Return that a line ends by a character that editors do not show as its end."""
    content = before[before.rfind("\n") + 1 :]
    found = re.search("[\x85\u2028\u2029]", content)
    if found is None:
        return None
    words = say("the character U+{code} ends a line here: write an ordinary end of line", code=f"{ord(found[0]):04X}")
    return YamlError(len(_BREAKS.split(before[: -len(content)])), found.start() + 1, words)


def _within(line: int, column: int, lines: list[str]) -> tuple[int, int]:
    """Return a place counted from 1; what is missed at the very end, at the last line's end."""
    while line > 0 and (line >= len(lines) or not lines[line].strip()):
        line -= 1
        column = len(lines[line].rstrip())
    return line + 1, column + 1


def _meant(words: str, known: dict[str, str]) -> str:
    return next((said for begin, said in known.items() if words.startswith(begin)), "")

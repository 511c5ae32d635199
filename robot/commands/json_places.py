"""Parses JSON and keeps the place of every value, so that an error can point at it.

The standard parser reports where a syntax error is, but not where a value was; it also accepts nan,
infinities and duplicate keys, and deeply nested text overflows its stack. RFC 8259.

What models write in its place and what can be read in one way only is read: strings and constants
of Python, a comma after the last member, and a number with the very unit of its field.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass, field
from json import JSONDecodeError, JSONDecoder
from types import MappingProxyType
from typing import Any, NamedTuple, TypeAlias

from text.i18n import translated

_NAMED = (
    ("tag", re.compile(r"(?P<tag></?think>)")),
    ("fence", re.compile(r"```|~~~")),
    ("comment", re.compile(r"//|/\*|#")),
    ("backslash", re.compile(r"\\")),
    ("quotes", re.compile("(?P<quote>[“”„‟‘’‚«»'`])")),
    ("not_finite", re.compile(r"[+-]?(?:nan|inf(?:inity)?)\b", re.IGNORECASE)),
    ("number_form", re.compile(r"\+[0-9.]|-?\.[0-9]")),
)
"""Code, a key of `robot.commands.problems.TEMPLATES`, and what begins there."""
_ALIKE: Mapping[str, str] = MappingProxyType(dict(zip("，：［］｛｝＂−–", ',:[]{}"--', strict=True)))
"""Signs of other keyboards, and JSON's own."""
_OF_OTHERS: Mapping[str, str] = MappingProxyType(
    {"true": "true", "false": "false", "none": "null", "null": "null", "undefined": "null"}
)
"""Words of other languages in lower case, and JSON's own."""
_WORD = re.compile(r"\w+")
_INVISIBLE = frozenset({"Cc", "Cf", "Zl", "Zp", "Zs"})
"""Categories of Unicode: controls, formats, separators."""


class Odd(NamedTuple):
    """A place where the text is not JSON."""

    code: str
    """Key of `robot.commands.problems.TEMPLATES`."""
    details: Mapping[str, str]


def odd(text: str, at: int) -> Odd | None:
    """Return what stands there instead of JSON, None if that has no name here.

    These are the habits of those who write it: people who know Python or JavaScript, models that talk,
    keyboards and editors that choose other signs.
    """
    for code, pattern in _NAMED:
        if found := pattern.match(text, at):
            return Odd(code, found.groupdict())
    sign, word = text[at : at + 1], _WORD.match(text, at)
    if sign in _ALIKE:
        return Odd("alike", {"sign": sign, "right": _ALIKE[sign]})
    if sign and unicodedata.category(sign) in _INVISIBLE:
        return Odd("invisible", {"number": f"U+{ord(sign):04X}"})
    if word and (right := _OF_OTHERS.get(word.group().lower())):
        return Odd("constant", {"word": word.group(), "right": right})
    return None


def outside(text: str, at: int) -> str:
    """Return the code of what stands there where the JSON as a whole should begin."""
    if at == len(text):
        return "nothing"
    return "words_before" if "{" in text[at:] else "words"


Path: TypeAlias = "tuple[str | int, ...]"
"""Keys and indices from the root to a value."""

MAX_DEPTH = 32

_STRINGS = JSONDecoder()
_PYTHON_STRING = re.compile(r"'((?:[^'\\]|\\.)*)'(?=[ \t\n\r]*(?:[,:}\]]|\Z))", re.DOTALL)
"""With what may follow: an apostrophe within would end it earlier."""
_ESCAPE_OR_QUOTE = re.compile(r"\\.|\"", re.DOTALL)
_AS_JSON: Mapping[str, str] = {"\\'": "'", '"': '\\"'}
"""Of these, what is written otherwise in JSON."""
_BLANK = re.compile(r"[ \t\n\r]*")
_NUMBER = re.compile(r"-?(?:0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?")
_PIECE = re.compile(r"\w{1,40}|\.\.\.|\S")
"""What is said of something that has no name in `robot.commands.json_places`."""
_DECIMAL_COMMA = re.compile(r"(-?[0-9]+),([0-9]+)")
_UNIT = re.compile(r"[ \t]*((?:[^\W\d_]|[°%])[^\s,\]}\"']*)")
_DIGIT = re.compile(r"[.0-9xX]")
_LONGEST_SHOWN = 24
_HALF_CHARACTER = re.compile("[\ud800-\udfff]")
_CONSTANTS: Mapping[str, bool | None] = {
    "true": True,
    "false": False,
    "null": None,
    "True": True,
    "False": False,
    "None": None,
}
_LONGEST_INT = 18
"""Maximum digits of a number that is kept as an integer."""


class JsonError(ValueError):
    """The text is not JSON as this module accepts it."""

    def __init__(self, code: str, offset: int, path: Path = (), **details: str | int) -> None:
        super().__init__(code)
        self.code = code
        self.offset = offset
        """Position in the text, in characters from 0."""
        self.path = path
        self.details = details


@dataclass(frozen=True)
class PlacedJson:
    """A JSON text as plain values, with their offsets."""

    value: Any
    values: dict[Path, int] = field(default_factory=dict)
    """Path to the offset where the value begins."""
    keys: dict[Path, int] = field(default_factory=dict)
    """Path to the offset where the key of the value begins, for members of objects."""


def read(text: str, units: Mapping[str, str] = MappingProxyType({})) -> PlacedJson:
    """Parse a whole JSON text; raises `JsonError`.

    `units` of fields, by name, may stand behind their numbers.
    """
    reader = _JsonScanner(text, units)
    value, end = reader.value(reader.blank(0), ())
    end = reader.blank(end)
    if "{" in text[end:]:
        raise JsonError("several", text.index("{", end))
    if end != len(text):
        raise reader.fault("text_after", end, ())
    return PlacedJson(value, reader.values, reader.keys)


def line_column(text: str, offset: int) -> tuple[int, int]:
    """Line and column, both from 1, of an offset in the text."""
    before = text[:offset]
    return before.count("\n") + 1, offset - (before.rfind("\n") + 1) + 1


class _JsonScanner:
    """Recursive descent: each method takes an offset and returns what it read and where it ends."""

    def __init__(self, text: str, units: Mapping[str, str]) -> None:
        self.text, self.units = text, units
        self.values: dict[Path, int] = {}
        self.keys: dict[Path, int] = {}

    def blank(self, at: int) -> int:
        match = _BLANK.match(self.text, at)
        return match.end() if match else at

    def value(self, at: int, path: Path) -> tuple[Any, int]:
        self.values[path] = at
        if len(path) > MAX_DEPTH:
            raise JsonError("too_deep", at, path[:1], limit=MAX_DEPTH)
        first = self.text[at : at + 1]
        if first == "{":
            return self.object(at, path)
        if first == "[":
            return self.array(at, path)
        if first in ('"', "'"):
            return self.string(at, path)
        for word, constant in _CONSTANTS.items():
            if self.text.startswith(word, at):
                return constant, at + len(word)
        return self.number(at, path)

    def object(self, at: int, path: Path) -> tuple[dict[str, Any], int]:
        members: dict[str, Any] = {}
        at = self.blank(at + 1)
        if self.text.startswith("}", at):
            return members, at + 1
        while True:
            if not self.text.startswith(('"', "'"), at):
                raise self.fault("key_expected", at, path)
            key, end = self.string(at, path)
            if key in members:
                raise JsonError("duplicate", at, (*path, key), name=key)
            self.keys[(*path, key)] = at
            end = self.blank(end)
            if not self.text.startswith(":", end):
                raise self.fault("colon_expected", end, (*path, key))
            members[key], end = self.value(self.blank(end + 1), (*path, key))
            at, done = self.separator(end, path, "}")
            if done:
                return members, at

    def array(self, at: int, path: Path) -> tuple[list[Any], int]:
        items: list[Any] = []
        at = self.blank(at + 1)
        if self.text.startswith("]", at):
            return items, at + 1
        while True:
            item, end = self.value(at, (*path, len(items)))
            items.append(item)
            at, done = self.separator(end, path, "]")
            if done:
                return items, at

    def separator(self, at: int, path: Path, closing: str) -> tuple[int, bool]:
        """Step over a comma, over the closing bracket (then return True), or over both."""
        at = self.blank(at)
        if self.text.startswith(closing, at):
            return at + 1, True
        if not self.text.startswith(",", at):
            raise self.fault("comma_expected", at, path, closing=closing)
        after = self.blank(at + 1)
        return (after + 1, True) if self.text.startswith(closing, after) else (after, False)

    def fault(self, code: str, at: int, path: Path, **details: str) -> JsonError:
        """Return the error for something else than what is due here, by its name if it has one."""
        if named := odd(self.text, at):
            return JsonError(named.code, at, path, **named.details)
        if code == "value_expected" and not path:
            code = outside(self.text, at)
        elif code == "value_expected" and (found := _PIECE.match(self.text, at)):
            return JsonError("other_expected", at, path, found=found[0])
        return JsonError(code, at, path, **details)

    def string(self, at: int, path: Path) -> tuple[str, int]:
        if self.text[at] == "'":
            text, end = self.python_string(at, path)
        else:
            try:
                text, end = _STRINGS.raw_decode(self.text, at)
            except JSONDecodeError as error:
                raise JsonError("string_bad", min(error.pos, len(self.text)), path) from None
        if _HALF_CHARACTER.search(text):
            raise JsonError("half_character", at, path)
        return text, end

    def python_string(self, at: int, path: Path) -> tuple[str, int]:
        found = _PYTHON_STRING.match(self.text, at)
        if found is None:
            raise JsonError("quotes", at, path, quote="'")
        inner = _ESCAPE_OR_QUOTE.sub(lambda one: _AS_JSON.get(one[0], one[0]), found[1])
        try:
            return _STRINGS.decode(f'"{inner}"'), found.end()
        except JSONDecodeError:
            raise JsonError("string_bad", at, path) from None

    def number(self, at: int, path: Path) -> tuple[int | float, int]:
        match = _NUMBER.match(self.text, at)
        if match is None:
            raise self.fault("value_expected", at, path)
        if _DIGIT.match(self.text, match.end()):
            raise JsonError("number_form", at, path)
        comma = _DECIMAL_COMMA.match(self.text, at)
        if comma and not (path and isinstance(path[-1], int)):
            # In a list a comma may separate two numbers; elsewhere no number can follow a comma.
            raise JsonError("decimal_comma", at, path, mended=".".join(comma.groups()))
        digits, end = match.group(), self.unit(match, path)
        if match.group(1) or match.group(2) or len(digits) > _LONGEST_INT:
            if math.isinf(float(digits)):
                raise JsonError("too_large", at, path, number=digits[:_LONGEST_SHOWN])
            return float(digits), end
        return int(digits), end

    def unit(self, number: re.Match[str], path: Path) -> int:
        """Step over the unit of a number, in either language; any other is not converted."""
        found = _UNIT.match(self.text, number.end())
        own = self.units.get(str(path[-1])) if path else None
        if found is None or own is None:
            return number.end()
        word = found[1]
        if word not in (own, translated(own, "ru")):
            shown = number.group()[:_LONGEST_SHOWN]
            raise JsonError("unit", found.start(1), path, word=word, number=shown, unit=own)
        return found.end()

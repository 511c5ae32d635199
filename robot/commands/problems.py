"""Errors in a response of the LLM, in words, with their places in the text.

A message is a template and its arguments, so that a screen can translate it.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from robot.commands.json_places import Path
from text.i18n import N_, translated
from text.plain import plain

TEMPLATES: Mapping[str, str] = MappingProxyType(
    {
        "too_big": N_("{size} bytes are too many: {limit} at most"),
        "encoding": N_("the text is not UTF-8"),
        "value_expected": N_("a value is expected here"),
        "other_expected": N_("a value is expected here, not {found}"),
        "key_expected": N_("a field name in double quotes is expected here"),
        "colon_expected": N_("a colon is expected after the field name"),
        "comma_expected": N_("a comma or {closing} is expected here"),
        "string_bad": N_("the closing quote is missing, or a character needs a backslash"),
        "half_character": N_("this string holds half a character (a lone surrogate)"),
        "quotes": N_('write straight double quotes (") in place of {quote}'),
        "tag": N_("leave {tag} out: the JSON alone is expected"),
        "thoughts": N_("only thoughts (<think>) stand here: no JSON follows </think>"),
        "fence": N_("leave the code fence (```) out: the JSON alone is expected"),
        "nothing": N_("the text is empty"),
        "words": N_("only words stand here: a JSON object is expected"),
        "words_before": N_("leave the words before the JSON out"),
        "several": N_("more than one JSON object stands here: one alone is expected"),
        "backslash": N_("a backslash stands in strings alone: leave it out"),
        "comment": N_("JSON has no comments: leave it out"),
        "alike": N_("write {right} in place of {sign}"),
        "invisible": N_("a character that cannot be seen ({number}) stands here: remove it"),
        "constant": N_("in JSON it is written {right}, not {word}"),
        "number_form": N_("a number is written 2, -2, 0.5 or 2.0 here, and in no other form"),
        "unit": N_("{word} stands behind {number}; this field is in {unit}"),
        "too_large": N_("{number} is too large for a number"),
        "not_finite": N_("nan and infinity are not allowed"),
        "decimal_comma": N_("write a fraction with a point: {mended}"),
        "too_deep": N_("nested too deeply: {limit} levels at most"),
        "text_after": N_("nothing may follow the end of the JSON"),
        "duplicate": N_("the field {name} appears twice here"),
        "missing": N_("the field {name} is missing"),
        "unknown": N_("there is no field {name}"),
        "unknown_near": N_("there is no field {name}: did you mean {near}?"),
        "action": N_("must be one of {choices}"),
        "object": N_("must be an object in curly brackets"),
        "list": N_("must be a list in square brackets"),
        "text": N_("must be a string in double quotes"),
        "number": N_("must be a number"),
        "whole": N_("must be a whole number"),
        "range": N_("must be from {low:g} to {high:g} {unit}, not {value:g}"),
        "too_many": N_("{count} commands are too many: {limit} at most"),
        "invalid": N_("is not valid"),
    }
)
"""Code of a problem to its message in English, for `str.format` with the arguments."""

_UNITS = (N_("m/s"), N_("rad"), N_("deg"))
"""Marked for the catalogue: in Russian units have their own letters."""
_LONGEST_NAME = 40


@dataclass(frozen=True)
class Problem:
    """One error and its place."""

    field: str
    """`commands[1].speed`; empty for the text as a whole."""
    line: int
    """Counted from 1."""
    column: int
    """In characters, counted from 1."""
    message: str
    """In English, without the place."""
    code: str = "invalid"
    """Key of `TEMPLATES`."""
    args: Mapping[str, str | float] = dataclasses.field(default_factory=dict)
    """Values of the template's fields."""

    @classmethod
    def of(cls, code: str, path: Path = (), place: tuple[int, int] = (1, 1), **args: str | float) -> Problem:
        """Make a problem, its message from the template; `place` is line and column."""
        shown = {name: shown_name(value) if isinstance(value, str) else value for name, value in args.items()}
        message = TEMPLATES[code].format(**shown)
        return cls(field_name(path), *place, message, code, MappingProxyType(shown))

    def in_language(self, code: str) -> str:
        """The message in a language, without the place."""
        # Numbers keep their decimal point, as in the JSON.
        args = {**self.args, "unit": translated(str(self.args.get("unit", "")), code)}
        return translated(TEMPLATES[self.code], code).format(**args)

    def __str__(self) -> str:
        """Place, field and message in one line."""
        return f"{self.line}:{self.column}: {self.field + ': ' if self.field else ''}{self.message}"


class CommandError(ValueError):
    """The response is refused; no part of it may be executed."""

    def __init__(self, problems: Sequence[Problem]) -> None:
        super().__init__("; ".join(map(str, problems)))
        self.problems: tuple[Problem, ...] = tuple(problems)


def field_name(path: Path) -> str:
    """Write `('commands', 1, 'speed')` as `commands[1].speed`."""
    parts = (f"[{part}]" if isinstance(part, int) else f".{shown_name(part)}" for part in path)
    return "".join(parts).removeprefix(".")


def shown_name(name: str) -> str:
    """Make an untrusted name fit to show: printable and of limited length."""
    return plain(name, _LONGEST_NAME) + ("" if len(name) <= _LONGEST_NAME else "…")

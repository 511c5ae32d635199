"""What is wrong with a response of the LLM, in words, and where in its text.

A message is a template and its arguments, so that a screen can say it in another language.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

from text.plain import plain

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from robot.commands.json_places import Path

TEMPLATES: Mapping[str, str] = MappingProxyType(
    {
        "too_big": "{size} bytes are too many: {limit} at most",
        "encoding": "the text is not UTF-8",
        "value_expected": "a value is expected here",
        "key_expected": "a field name in double quotes is expected here",
        "colon_expected": "a colon is expected after the field name",
        "comma_expected": "a comma or {closing} is expected here",
        "string_bad": "this text in quotes is not finished, or a character in it needs a backslash",
        "half_character": "this text holds half a character (a lone surrogate)",
        "not_finite": "nan and infinity are no numbers that a robot can follow",
        "decimal_comma": "write a fraction with a point: {mended}",
        "too_deep": "nested too deeply: {limit} levels at most",
        "text_after": "nothing may follow the end of the JSON",
        "duplicate": "the field {name} stands here twice",
        "missing": "the field {name} is missing",
        "unknown": "there is no field {name}",
        "unknown_near": "there is no field {name}: did you mean {near}?",
        "action": "must be one of {choices}",
        "object": "must be an object in curly brackets",
        "list": "must be a list in square brackets",
        "text": "must be a text in double quotes",
        "number": "must be a number",
        "whole": "must be a whole number",
        "range": "must be from {low:g} to {high:g} {unit}, not {value:g}",
        "too_many": "{count} commands are too many: {limit} at most",
        "invalid": "is not valid",
    }
)
"""Code of a problem to its message in English, for `str.format` with the arguments."""

TEMPLATES_RU: Mapping[str, str] = MappingProxyType(
    {
        "too_big": "{size} байт — слишком много: не больше {limit}",
        "encoding": "текст не в UTF-8",
        "value_expected": "здесь должно быть значение",
        "key_expected": "здесь должно быть имя поля в двойных кавычках",
        "colon_expected": "после имени поля должно быть двоеточие",
        "comma_expected": "здесь должна быть запятая или {closing}",
        "string_bad": "кавычка не закрыта, или символ нужно экранировать обратной косой чертой",
        "half_character": "в этом тексте половина символа (одиночный суррогат)",
        "not_finite": "nan и бесконечность недопустимы",
        "decimal_comma": "дробь — через точку: {mended}",
        "too_deep": "слишком глубокая вложенность: не больше {limit}",
        "text_after": "после конца JSON ничего быть не должно",
        "duplicate": "поле {name} здесь дважды",
        "missing": "нет поля {name}",
        "unknown": "неизвестное поле {name}",
        "unknown_near": "неизвестное поле {name}: может быть, {near}?",
        "action": "должно быть одним из: {choices}",
        "object": "должно быть объектом в фигурных скобках",
        "list": "должно быть списком в квадратных скобках",
        "text": "должно быть текстом в двойных кавычках",
        "number": "должно быть числом",
        "whole": "должно быть целым числом",
        "range": "должно быть от {low:g} до {high:g} {unit}, а не {value:g}",
        "too_many": "{count} команд — слишком много: не больше {limit}",
        "invalid": "недопустимо",
    }
)
"""The same in Russian."""

_UNITS_RU = MappingProxyType({"m/s": "м/с", "rad": "рад", "deg": "°"})
_LONGEST_NAME = 40


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong, and where."""

    field: str
    """`commands[1].speed`; empty for the text as a whole."""
    line: int
    """From 1."""
    column: int
    """From 1, in characters."""
    message: str
    """In English, without the place."""
    code: str = "invalid"
    """Key of `TEMPLATES`."""
    args: Mapping[str, str | float] = dataclasses.field(default_factory=dict)
    """What the template's fields stand for."""

    @classmethod
    def of(
        cls, code: str, path: Path = (), place: tuple[int, int] = (1, 1), **args: str | float
    ) -> Problem:
        """Make a problem with its message from the template; `place` is line and column."""
        shown = {
            name: shown_name(value) if isinstance(value, str) else value
            for name, value in args.items()
        }
        message = TEMPLATES[code].format(**shown)
        return cls(field_name(path), *place, message, code, MappingProxyType(shown))

    def in_russian(self) -> str:
        """The message in Russian, without the place."""
        unit = str(self.args.get("unit", ""))
        # Numbers keep their point: so they are written in the JSON.
        args = {**self.args, "unit": _UNITS_RU.get(unit, unit)}
        return TEMPLATES_RU[self.code].format(**args)

    def __str__(self) -> str:
        """Place, field and message in one line."""
        return f"{self.line}:{self.column}: {self.field + ': ' if self.field else ''}{self.message}"


class CommandError(ValueError):
    """The response is refused; nothing of it may be executed."""

    def __init__(self, problems: Sequence[Problem]) -> None:
        super().__init__("; ".join(map(str, problems)))
        self.problems: tuple[Problem, ...] = tuple(problems)


def field_name(path: Path) -> str:
    """Write `('commands', 1, 'speed')` as `commands[1].speed`."""
    parts = (f"[{part}]" if isinstance(part, int) else f".{shown_name(part)}" for part in path)
    return "".join(parts).removeprefix(".")


def shown_name(name: str) -> str:
    """Make a name from outside fit to be shown: printable and of a sane length."""
    return plain(name, _LONGEST_NAME) + ("" if len(name) <= _LONGEST_NAME else "…")

"""Turns pydantic's errors into problems that name one field, one place and the fix.

A command is one of several models; pydantic reports the errors against each of them. Here the
`action` decides which model was meant, and only that one is checked.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel, ValidationError

from robot.commands.json_places import Path, PlacedJson, line_column
from robot.commands.problems import Problem
from robot.limits import MAX_COMMANDS, OF_COMMANDS
from text.suggestions import nearest

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from pydantic_core import ErrorDetails

MAX_PROBLEMS = 20

_CODES = {
    "missing": "missing",
    "extra_forbidden": "unknown",
    "greater_than_equal": "range",
    "less_than_equal": "range",
    "finite_number": "range",
    "float_type": "number",
    "int_type": "whole",
    "int_from_float": "whole",
    "string_type": "text",
    "list_type": "list",
    "model_type": "object",
    "model_attributes_type": "object",
    "too_long": "too_many",
}
"""Pydantic's error types to codes of `problems.TEMPLATES`."""


class Explainer:
    """Checks a refused JSON text again, against one model at a time."""

    def __init__(
        self, text: str, found: PlacedJson, envelope: type[BaseModel], commands: Mapping[str, type[BaseModel]]
    ) -> None:
        self._text = text
        self._found = found
        self._envelope = envelope
        self._commands = commands
        """Value of `action` to the model of the command."""

    def problems(self) -> tuple[Problem, ...]:
        """At most `MAX_PROBLEMS` problems, in the order of the text."""
        everything = [*self._of_envelope(), *self._of_commands()]
        everything.sort(key=lambda problem: (problem.line, problem.column))
        return tuple(everything[:MAX_PROBLEMS])

    def _of_envelope(self) -> Iterator[Problem]:
        for error in _errors(self._envelope, self._found.value):
            if len(error["loc"]) <= 1:
                yield self._problem(error, error["loc"], self._envelope)

    def _of_commands(self) -> Iterator[Problem]:
        value = self._found.value
        commands = value.get("commands") if isinstance(value, dict) else None
        if not isinstance(commands, list) or len(commands) > MAX_COMMANDS:
            return
        for index, command in enumerate(commands):
            path: Path = ("commands", index)
            if not isinstance(command, dict):
                yield Problem.of("object", path, self._place(path))
            elif "action" not in command:
                yield Problem.of("missing", (*path, "action"), self._place(path), name="action")
            else:
                yield from self._of_command(command, path)

    def _of_command(self, command: dict[str, Any], path: Path) -> Iterator[Problem]:
        action = command["action"]
        model = self._commands.get(action) if isinstance(action, str) else None
        if model is None:
            place = self._place((*path, "action"))
            yield Problem.of("action", (*path, "action"), place, choices=", ".join(self._commands))
            return
        for error in _errors(model, command):
            yield self._problem(error, (*path, *error["loc"]), model)

    def _problem(self, error: ErrorDetails, path: Path, model: type[BaseModel]) -> Problem:
        code = _CODES.get(error["type"], "invalid")
        name, value = str(path[-1]) if path else "", error["input"]
        if code == "missing":
            return Problem.of(code, path, self._place(path[:-1]), name=name)
        if code == "unknown":
            return self._unknown(path, name, model)
        if code == "range" and name in OF_COMMANDS:
            limits = OF_COMMANDS[name]
            args = {"low": limits.low, "high": limits.high, "value": _finite(value)}
            return Problem.of(code, path, self._place(path), unit=limits.unit, **args)
        if code == "too_many":
            return Problem.of(code, path, self._place(path), count=len(value), limit=MAX_COMMANDS)
        return Problem.of(code, path, self._place(path))

    def _unknown(self, path: Path, name: str, model: type[BaseModel]) -> Problem:
        place = line_column(self._text, self._found.keys[path])
        if meant := nearest(name, model.model_fields):
            return Problem.of("unknown_near", path, place, name=name, near=meant)
        return Problem.of("unknown", path, place, name=name)

    def _place(self, path: Path) -> tuple[int, int]:
        return line_column(self._text, self._found.values.get(path, 0))


def _finite(value: float) -> float:
    """Return a finite number: arguments may be sent as JSON, which has no infinities."""
    return max(-sys.float_info.max, min(sys.float_info.max, float(value)))


def _errors(model: type[BaseModel], value: object) -> list[ErrorDetails]:
    try:
        model.model_validate(value)
    except ValidationError as error:
        return error.errors(include_url=False, include_context=False)
    return []

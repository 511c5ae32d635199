"""What an LLM may ask of the robot: the schema, and the only entry point for its JSON.

`LlmResponse.model_json_schema()` already obeys the rules of strict structured output (every field
required, no additional properties, `anyOf` and no `oneOf`, no defaults), so the class can be given
to an API as a response format. The ranges are enforced here, whatever the API does.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal, TypeVar, Union, overload

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError
from pydantic_core import ErrorDetails

from robot.commands.json_places import Path, PlacedJson, line_column
from robot.commands.problems import TEMPLATES, CommandError, Problem
from robot.commands.wrapping import read_answer, straightened, unwrapped
from robot.limits import HEAD_ANGLE, MAX_BYTES, MAX_COMMANDS, OF_COMMANDS, SPEED, STEERING
from text.suggestions import nearest

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
    """Checks a refused JSON text again, against one model at a time.

    A command is one of several models; pydantic reports the errors against each of them. Here the
    `action` decides which model was meant, and only that one is checked.
    """

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


__all__ = [
    "HEAD_ANGLE",
    "MAX_BYTES",
    "MAX_COMMANDS",
    "SPEED",
    "STEERING",
    "TEMPLATES",
    "CommandError",
    "DriveCommand",
    "HeadCommand",
    "LlmResponse",
    "Problem",
    "SpokenResponse",
    "parse_llm",
]


def _whole(value: object) -> object:
    """Accept 45.0 for 45: JSON has only one kind of number."""
    return int(value) if isinstance(value, float) and value.is_integer() else value


Speed = Annotated[
    float,
    Field(
        strict=True, ge=SPEED.low, le=SPEED.high, description="Speed in m/s, from -0.5 (backward) to 0.5 (forward)"
    ),
]
Steering = Annotated[
    float,
    Field(
        strict=True,
        ge=STEERING.low,
        le=STEERING.high,
        description="Steering angle in radians, from -0.5 (right) to 0.5 (left)",
    ),
]
# The order matters: a range outside the `BeforeValidator` would be missing from the schema.
Degrees = Annotated[int, Field(strict=True, ge=int(HEAD_ANGLE.low), le=int(HEAD_ANGLE.high)), BeforeValidator(_whole)]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class DriveCommand(_Strict):
    """Drive at a speed and a steering angle until told otherwise."""

    action: Literal["drive"]
    speed: Speed
    steering: Steering


class HeadCommand(_Strict):
    """Turn the head."""

    action: Literal["turn_head"]
    pan: Annotated[Degrees, Field(description="Left and right in whole degrees, -90 to 90")]
    tilt: Annotated[Degrees, Field(description="Up and down in whole degrees, -90 to 90")]


class LlmResponse(_Strict):
    """What the model thinks, and what it wants done, in order."""

    thought: Annotated[str, Field(strict=True, description="Why these commands were chosen")]
    # A discriminator would be the usual way to tell the two apart, but it produces a `oneOf`.
    commands: Annotated[
        list[Union[DriveCommand, HeadCommand]],  # noqa: UP007 - the schema's own words
        Field(max_length=MAX_COMMANDS, description="What to do, in order"),
    ]


class SpokenResponse(LlmResponse):
    """The same with something to say: what the robot's brain asks a model for."""

    say: Annotated[str, Field(strict=True, description="What to say aloud, one short sentence; may be empty")]

    def silent(self) -> LlmResponse:
        """Return it without the words: what goes to `llm_parser`."""
        return LlmResponse(thought=self.thought, commands=self.commands)


Response = TypeVar("Response", bound=LlmResponse)


@overload
def parse_llm(text: str | bytes) -> LlmResponse: ...
@overload
def parse_llm(text: str | bytes, kind: type[Response]) -> Response: ...
def parse_llm(text: str | bytes, kind: type[LlmResponse] = LlmResponse) -> LlmResponse:
    """Parse and check a response; raises `CommandError` with every problem found and its place."""
    decoded = _decode(text)
    found = read_answer(decoded)
    try:
        return kind.model_validate(found.value)
    except ValidationError:
        models: dict[str, type[BaseModel]] = {"drive": DriveCommand, "turn_head": HeadCommand}
        problems = Explainer(decoded, found, kind, models).problems()
        raise CommandError(problems) from None


def _decode(text: str | bytes) -> str:
    size = len(text.encode("utf-8", "surrogatepass") if isinstance(text, str) else text)
    if size > MAX_BYTES:
        raise CommandError([Problem.of("too_big", size=size, limit=MAX_BYTES)])
    if isinstance(text, str):
        return text
    try:
        return text.decode("utf-8")
    except UnicodeDecodeError as error:
        before = text[: error.start].decode("utf-8")
        place = line_column(before, len(before))
        raise CommandError([Problem.of("encoding", place=place)]) from None


_CLOSING = {"{": "}", "[": "]"}
_COMMAND_LEVEL = 2
"""Brackets that are open between two commands: that of the response, and that of the list."""


def so_far(text: str) -> tuple[int, tuple[Problem, ...]]:
    """Return how many whole commands have come, and the problems that no continuation can fix.

    The beginning of a response is cut behind its last whole command, and closed; what is missing from
    the response as a whole may still come, and is no mistake.
    """
    text = straightened(unwrapped(text, whole=False))
    begun = text.lstrip()
    if not begun.startswith("{"):
        # Thoughts or words: a fence or </think> may still fix them.
        return 0, ()
    try:
        response = parse_llm(_closed(text))
    except CommandError as error:
        wrong = tuple(problem for problem in error.problems if not _may_still_come(problem))
        return 0, wrong
    return len(response.commands), ()


def _may_still_come(problem: Problem) -> bool:
    return problem.code == "missing" and problem.field in ("thought", "commands")


def _closed(text: str) -> str:
    """Return the beginning up to the last place between commands, with all brackets closed."""
    stack: list[str] = []
    cut, closing = 0, ""
    quote, escaped = "", False
    for at, character in enumerate(text):
        if quote:
            quote = quote if escaped or character != quote else ""
            escaped = not escaped and character == "\\"
        elif character in "\"'":
            quote = character
        elif character in _CLOSING:
            stack.append(_CLOSING[character])
            cut, closing = _cut(stack, at + 1) or (cut, closing)
        elif character in "]}":
            if not stack or stack.pop() != character:
                # Whatever follows, this is wrong: the check itself says what is.
                return text[: at + 1]
            cut, closing = _cut(stack, at + 1) or (cut, closing)
        elif character == ",":
            cut, closing = _cut(stack, at) or (cut, closing)
    return text if not stack and cut else text[:cut] + closing


def _cut(stack: list[str], at: int) -> tuple[int, str] | None:
    return (at, "".join(reversed(stack))) if len(stack) <= _COMMAND_LEVEL else None

"""What an LLM may ask of the robot: the schema, and the only entry point for its JSON.

`LlmResponse.model_json_schema()` already obeys the rules of strict structured output (every field
required, no additional properties, `anyOf` and no `oneOf`, no defaults), so the class can be given
to an API as a response format. The ranges are enforced here, whatever the API does.
"""

from __future__ import annotations

from typing import Annotated, Literal, TypeVar, Union, overload

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from robot.commands.explain import Explainer
from robot.commands.json_places import line_column
from robot.commands.problems import TEMPLATES, CommandError, Problem
from robot.commands.wrapping import read_answer
from robot.limits import HEAD_ANGLE, MAX_BYTES, MAX_COMMANDS, SPEED, STEERING

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

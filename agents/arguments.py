"""The arguments of the tools, as an agent has to write them: checked, and bounded."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from agents.raw_access import full_name
from robot.limits import HEAD_ANGLE, MAX_COMMANDS
from text.plain import plain
from text.ros_names import TOPIC_NAME

LONGEST_TEXT = 300


def _name(text: str) -> str:
    name = full_name(text)
    if not TOPIC_NAME.fullmatch(name):
        raise ValueError("not a ROS name; write it as /sensor/sonar_front")
    return name


def _printable(text: str) -> str:
    return plain(" ".join(text.split()))


RosName = Annotated[str, Field(max_length=200), AfterValidator(_name)]
Reason = Annotated[
    str,
    Field(max_length=LONGEST_TEXT, description="Why, in a sentence for the person at the screen."),
    AfterValidator(_printable),
]
Degrees = Annotated[int, Field(ge=int(HEAD_ANGLE.low), le=int(HEAD_ANGLE.high))]


class Arguments(BaseModel):
    """Base: nothing else is accepted."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class NoArguments(Arguments):
    """Of a tool that takes none."""


class SeeArguments(Arguments):
    """Arguments of the tool `see`."""

    topic: RosName | None = Field(None, description="By default the robot's own camera.")
    width: int = Field(640, ge=32, le=1280, description="Longest side in pixels.")


class FindArguments(Arguments):
    """Of `topics` and `graph`."""

    contains: str = Field("", max_length=100, description="Only names with this text in them.")


class EchoArguments(Arguments):
    """Arguments of the tool `echo`."""

    topic: RosName
    count: int = Field(1, ge=1, le=10, description="How many messages.")
    seconds: float = Field(3.0, gt=0, le=10, description="How long to wait for them.")


class ProposeArguments(Arguments):
    """Arguments of the tool `propose`."""

    commands: list[dict[str, Any]] = Field(
        max_length=MAX_COMMANDS,
        description='Such as {"action": "drive", "speed": 0.2, "steering": 0.0} (m/s; rad, + is '
        'left) and {"action": "turn_head", "pan": -45, "tilt": 10} (degrees). One drive at most.',
    )
    reason: Reason = ""


class ExecuteArguments(Arguments):
    """Arguments of the tool `execute`."""

    proposal: str = Field(max_length=20, description="The id that `propose` has returned.")


class HeadArguments(Arguments):
    """Arguments of the tool `head`."""

    pan: Degrees = Field(description="Left and right in whole degrees.")
    tilt: Degrees = Field(description="Up and down in whole degrees.")
    reason: Reason = ""


class SayArguments(Arguments):
    """Arguments of the tool `say`."""

    text: Annotated[str, Field(min_length=1, max_length=LONGEST_TEXT), AfterValidator(_printable)] = Field(
        description="What the robot says aloud."
    )


class PublishArguments(Arguments):
    """Arguments of the tool `publish`."""

    topic: RosName
    message: dict[str, Any] = Field(description="The fields of one message.")


class CallArguments(Arguments):
    """Arguments of the tool `call`."""

    service: RosName
    request: dict[str, Any] = Field(description="The fields of the request.")

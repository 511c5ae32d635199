"""The tools: a function each, whose parameters are the arguments that an agent has to write, checked and bounded."""

from __future__ import annotations

import inspect
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias, get_type_hints

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, create_model

from robot.limits import HEAD_ANGLE, MAX_COMMANDS
from text.plain import plain
from text.ros_names import TOPIC_NAME

if TYPE_CHECKING:
    from agents.session import RobotSession
    from launcher.consent import AgentRules

LONGEST_TEXT = 300
Facts: TypeAlias = dict[str, object]


def full_name(name: str) -> str:
    """Return the name of a topic or service from the root."""
    return f"/{name.lstrip('/')}"


def _name(text: str) -> str:
    name = full_name(text)
    if not TOPIC_NAME.fullmatch(name):
        raise ValueError("not a ROS name; write it as /sensor/sonar_front")
    return name


def _printable(text: str) -> str:
    return plain(" ".join(text.split()))


RosName = Annotated[str, Field(max_length=200), AfterValidator(_name)]
Camera = Annotated[RosName | None, Field(description="By default the robot's own camera.")]
Width = Annotated[int, Field(ge=32, le=1280, description="Longest side in pixels.")]
Part = Annotated[str, Field(max_length=100, description="Only names with this text in them.")]
Count = Annotated[int, Field(ge=1, le=10, description="How many messages.")]
Seconds = Annotated[float, Field(gt=0, le=10, description="How long to wait for them.")]
Commands = Annotated[
    list[dict[str, Any]],
    Field(
        max_length=MAX_COMMANDS,
        description='Such as {"action": "drive", "speed": 0.2, "steering": 0.0} (m/s; rad, + is '
        'left) and {"action": "turn_head", "pan": -45, "tilt": 10} (degrees). One drive at most.',
    ),
]
Reason = Annotated[
    str,
    Field(max_length=LONGEST_TEXT, description="Why, in a sentence for the person at the screen."),
    AfterValidator(_printable),
]
ProposalId = Annotated[str, Field(max_length=20, description="The id that `propose` has returned.")]
_Degrees = Annotated[int, Field(ge=int(HEAD_ANGLE.low), le=int(HEAD_ANGLE.high))]
Pan = Annotated[_Degrees, Field(description="Left and right in whole degrees.")]
Tilt = Annotated[_Degrees, Field(description="Up and down in whole degrees.")]
Said = Annotated[
    str,
    Field(min_length=1, max_length=LONGEST_TEXT, description="What the robot says aloud."),
    AfterValidator(_printable),
]
Message = Annotated[dict[str, Any], Field(description="The fields of one message.")]
Request = Annotated[dict[str, Any], Field(description="The fields of the request.")]


@dataclass(frozen=True)
class Caller:
    """The agent that calls."""

    key: str
    """Distinguishes it from others."""
    name: str
    """As it calls itself."""


@dataclass(frozen=True)
class Call:
    """One call of a tool."""

    session: RobotSession
    driving: Any
    """An `agents.driving.AgentDriving`, whose module has tools itself."""
    caller: Caller


@dataclass(frozen=True)
class Tool:
    """A tool of an agent."""

    name: str
    about: str
    """For the model that chooses it."""
    arguments: type[BaseModel]
    do: Callable[..., Awaitable[Facts | tuple[str, Facts]]]
    """Takes the call and the arguments; returns facts, and perhaps before them a JPEG in base64."""
    acts: bool = False
    """Whether it does more than look."""
    tells: bool = False
    """Whether it tells the log itself, before it acts."""
    waits: bool = True
    """Whether it waits until the graph is known, right after the start."""


TOOLS: dict[str, Tool] = {}
_STRICT = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


def tool(**how: bool) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Make a tool of a function: agents read its docstring, and the parameters after the call are its arguments."""

    def register(do: Callable[..., Any]) -> Callable[..., Any]:
        hints = get_type_hints(do, include_extras=True)
        _call, *parameters = inspect.signature(do).parameters.values()
        empty = inspect.Parameter.empty
        fields: dict[str, Any] = {
            one.name: (hints[one.name], ... if one.default is empty else one.default) for one in parameters
        }
        arguments = create_model(do.__name__, __config__=_STRICT, **fields)
        name = do.__name__.removesuffix("_aloud")
        TOOLS[name] = Tool(name, " ".join((do.__doc__ or "").split()), arguments, do, **how)
        return do

    return register


def tools_for(rules: AgentRules | None) -> tuple[Tool, ...]:
    """Return the tools; direct publishing and calling only where a profile lists something."""
    listed = {"publish": rules and rules.publish, "call": rules and rules.call}
    return tuple(tool for name, tool in TOOLS.items() if listed.get(name, True))

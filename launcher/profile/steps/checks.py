"""The kinds of checks: each a mapping whose one kind key says what is looked at.

A number may also be written as `${...}`, see `launcher.profile.steps.expressions`.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias, Union

from pydantic import BaseModel, BeforeValidator, ConfigDict, Discriminator, Field, Tag, WithJsonSchema

from launcher.parts import RosName, Texts, TypeName, refuse
from launcher.profile.steps.expressions import PLACE, written
from text.sentences import say

WITHIN_S = 5.0
LONGEST_S = 600.0
LOOK_AGAIN_S = 2.0
"""How long a check that only looks rests before it is judged again."""
_REST_S = {"PublishCheck": 5.0, "ServiceCheck": 5.0, "ParameterCheck": 5.0, "ActionCheck": 60.0}
PYTHON = re.compile(r"([A-Za-z_][\w-]*\.py):([A-Za-z_]\w*)")


def _number(value: object) -> object:
    if isinstance(value, str) and PLACE.fullmatch(value):
        return value
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise refuse(say("expected a number or ${{name}}, found {value!r}", value=value))
    return value


def _pattern(value: object) -> object:
    if isinstance(value, (int, float)):  # A drawn value
        return re.escape(written(value))
    if isinstance(value, str):
        try:
            re.compile(PLACE.sub("0", value))
        except re.error as error:
            words = say("{value!r} is not a regular expression: {why}", value=value, why=str(error))
            raise refuse(words) from error
    return value


def _several(value: object) -> object:
    return [value] if isinstance(value, str) else value


def _function(value: object) -> object:
    if isinstance(value, str) and not PYTHON.fullmatch(value):
        raise refuse(say("{value!r} is not a function; write checks.py:name", value=value))
    return value


Number = Annotated[
    Any,
    BeforeValidator(_number),
    WithJsonSchema({"anyOf": [{"type": "number"}, {"type": "string", "pattern": r"^\$\{.*\}$"}]}),
]
Range = Annotated[tuple[Number, Number], Field(strict=False)]
Pattern = Annotated[str, BeforeValidator(_pattern)]
Seconds = Annotated[float, Field(gt=0, le=LONGEST_S)]
Times = Annotated[int, Field(ge=1, le=1000)]


class Document(BaseModel):
    """Base of what only the client and the judge read of a profile: no unknown keys, no silent conversions."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)


class CheckDocument(Document):
    """What every check may say."""

    within: Seconds = Field(WITHIN_S, description="Seconds until it counts as failed.")
    what: Texts = Field({}, description="What is expected, if it can be said better, by language.")
    look: Texts = Field({}, description="Where to look when it fails, by language.")

    @property
    def rest_s(self) -> float:
        """How long it rests after it has failed: what does something must not play with the robot all the time."""
        return _REST_S.get(type(self).__name__, LOOK_AGAIN_S)


class NodeCheck(CheckDocument):
    """A node is in the graph, and ends when it is asked to."""

    node: RosName = Field(description="This node is in the ROS graph: `/sonar_front`.")
    ends: int | None = Field(
        None, description="It ends when it is asked to, with this exit code; it has to be a node of the profile."
    )
    signal: Literal["SIGINT", "SIGTERM"] = Field("SIGINT", description="With ends: how it is asked.")

    @property
    def rest_s(self) -> float:
        return LOOK_AGAIN_S if self.ends is None else 3600.0


class TopicCheck(CheckDocument):
    """Somebody publishes a topic, at a rate; or nobody does."""

    topic: RosName = Field(description="Somebody publishes this topic.")
    type: TypeName = Field(description="By this type: `std_msgs/msg/Float32`.")
    by: RosName | None = Field(None, description="The publisher is this node.")
    publishers: int | None = Field(None, ge=1, le=100, description="So many publishers.")
    rate: Range | None = Field(None, description="At least and at most so many messages a second: `[0.8, 1.2]`.")
    over: Seconds = Field(3.0, description="With rate: measured over so many seconds.")
    only: Annotated[tuple[RosName, ...], BeforeValidator(_several)] | None = Field(
        None, strict=False, description="Nobody publishes it but this node, or these, which need not."
    )
    silent: Seconds | None = Field(None, description="No message comes for so many seconds.")


class SubscriptionCheck(CheckDocument):
    """Somebody subscribes to a topic."""

    subscription: RosName = Field(description="Somebody subscribes to this topic.")
    by: RosName | None = Field(None, description="The subscriber is this node.")
    type: TypeName | None = Field(None, description="By this type.")


class FieldCheck(CheckDocument):
    """A field of a topic's messages."""

    field: RosName = Field(description="A field of the messages on this topic.")
    type: TypeName = Field(description="Their type.")
    path: str = Field(description="The field: `data`, `drive.speed`, `position[0]`.")
    between: Range | None = Field(None, description="It lies between these.")
    equals: Any = Field(None, description="It equals this.")
    tolerance: Number | None = Field(None, description="With equals: it may differ by so much.")
    changes: bool | None = Field(None, description="It is not the same in all messages.")
    matches: Pattern | None = Field(None, description="Its text has this regular expression.")
    messages: Times = Field(1, description="So many messages, each of which must comply.")


class ServiceCheck(CheckDocument):
    """A service answers a request, with the fields that `response` asks for."""

    service: RosName = Field(description="This service is called.")
    type: TypeName = Field(description="Its type: `example_interfaces/srv/AddTwoInts`.")
    request: dict[str, Any] = Field({}, description="Fields of the request.")
    response: dict[str, Any] = Field({}, description="Fields that the response must have.")
    tolerance: Number | None = Field(None, description="Numbers may differ by so much.")


class ActionCheck(CheckDocument):
    """An action is carried out."""

    action: RosName = Field(description="This action is sent a goal.")
    type: TypeName = Field(description="Its type: `deck_interfaces/action/DriveToPoint`.")
    goal: dict[str, Any] = Field({}, description="Fields of the goal.")
    accepted: bool = Field(True, description="Whether the goal must be accepted.")
    feedback: str | None = Field(None, description="A field that must come as feedback.")
    result: dict[str, Any] = Field({}, description="Fields that the result must have.")
    cancel: bool = Field(False, description="Cancel it after the first feedback; must be obeyed.")
    tolerance: Number | None = Field(None, description="Numbers may differ by so much.")


class PublishCheck(CheckDocument):
    """What follows when a message is published."""

    publish: RosName = Field(description="A message is published on this topic.")
    type: TypeName = Field(description="Its type.")
    message: dict[str, Any] = Field({}, description="Its fields.")
    repeat: Times = Field(1, description="So many times.")
    every: Seconds = Field(0.1, description="With repeat: seconds between two messages.")
    then: tuple[Check, ...] = Field(strict=False, min_length=1, description="What must be seen after that.")


class ParameterCheck(CheckDocument):
    """A parameter of a node."""

    parameter: str = Field(description="A parameter with this name is declared.")
    of: RosName = Field(description="By this node.")
    type: (
        Literal[
            "bool", "integer", "double", "string", "byte_array", "bool_array", "integer_array",
            "double_array", "string_array",
        ]
        | None
    ) = Field(None, description="It has this type.")  # fmt: skip
    value: Any = Field(None, description="It has this value.")
    set: Any = Field(None, description="It takes this value; the old one is put back.")
    refuses: Any = Field(None, description="It refuses this value.")


class LogCheck(CheckDocument):
    """A node logs a line."""

    log: str = Field(description="This node of the profile logs a line.")
    matches: Pattern = Field(description="It has this regular expression.")
    level: Literal["debug", "info", "warn", "error", "fatal"] | None = Field(None, description="With this severity.")
    lines: Times = Field(1, description="So many such lines.")


class PythonCheck(CheckDocument):
    """What a function of the lesson's folder says of the messages."""

    python: Annotated[str, BeforeValidator(_function)] = Field(
        description="A function of the lesson's folder: `checks.py:left_right`."
    )
    topics: dict[RosName, TypeName] = Field({}, description="Topics that it is given, with types.")
    over: Seconds | None = Field(None, description="It is asked only after so many seconds of messages.")


KINDS: dict[str, type[CheckDocument]] = {
    "node": NodeCheck,
    "topic": TopicCheck,
    "subscription": SubscriptionCheck,
    "field": FieldCheck,
    "service": ServiceCheck,
    "action": ActionCheck,
    "publish": PublishCheck,
    "parameter": ParameterCheck,
    "log": LogCheck,
    "python": PythonCheck,
}
"""The kinds of checks by their key."""


def kind_of(check: object) -> str | None:
    """Return the kind key of a check as written or read; None if it has none."""
    if isinstance(check, CheckDocument):
        return next(kind for kind, model in KINDS.items() if type(check) is model)
    if not isinstance(check, dict):
        return None
    return next((kind for kind in KINDS if kind in check), None)


if TYPE_CHECKING:
    Check: TypeAlias = CheckDocument
else:
    Check = Annotated[
        Union[tuple(Annotated[model, Tag(kind)] for kind, model in KINDS.items())],  # noqa: UP007
        Discriminator(kind_of),
    ]
PublishCheck.model_rebuild(_types_namespace={"Check": Check})

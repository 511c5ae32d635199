"""What the parts of a profile's model share: their base, and fields that several of them have."""

from __future__ import annotations

import re
from typing import Annotated

from pydantic import BaseModel, BeforeValidator, ConfigDict, WithJsonSchema
from pydantic_core import PydanticCustomError

from text.ros_names import ROS_NAME
from text.sentences import Words, say

TYPE_NAME = re.compile(r"[a-z][a-z0-9_]*/(msg|srv|action)/[A-Z][A-Za-z0-9]*")


def refuse(words: Words) -> PydanticCustomError:
    """Return the error with which a validator of this model rejects a value."""
    return PydanticCustomError("deck", "{words}", {"words": words})


def _texts(value: object) -> object:
    return {"en": value} if isinstance(value, str) else value


def ros_name(value: object) -> object:
    """Refuse text that is not a ROS name; everything else is refused by its type."""
    if isinstance(value, str) and not ROS_NAME.fullmatch(value):
        raise refuse(say("{value!r} is not a ROS name; write it as /sensor/sonar_front", value=value))
    return value


def _type_name(value: object) -> object:
    if isinstance(value, str) and not TYPE_NAME.fullmatch(value):
        raise refuse(say("{value!r} is not a message type; write it as std_msgs/msg/Float32", value=value))
    return value


Texts = Annotated[
    dict[str, str],
    BeforeValidator(_texts),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "string"},
                {
                    "type": "object",
                    "properties": {"en": {"type": "string"}, "ru": {"type": "string"}},
                    "additionalProperties": {"type": "string"},
                },
            ]
        }
    ),
]
RosName = Annotated[str, BeforeValidator(ros_name)]
TypeName = Annotated[str, BeforeValidator(_type_name)]


class Document(BaseModel):
    """Base of all parts of a profile: no unknown keys, no silent conversions."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)

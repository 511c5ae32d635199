"""What the parts of a profile are made of: how a value is read, what is refused, what editors are told of it.

They are dataclasses, which pydantic reads like models of its own: a supervisor has nodes, but no pydantic.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from inspect import get_annotations
from typing import Annotated, Any, ClassVar, TypeVar

from text.ros_names import ROS_NAME
from text.sentences import Words, say

M = TypeVar("M")

TYPE_NAME = re.compile(r"[a-z][a-z0-9_]*/(msg|srv|action)/[A-Z][A-Za-z0-9]*")


class AsText:
    """Every scalar inside is taken as text, exactly as written: `0.10`, `yes`, `9`."""


class Joined:
    """`extends` merges the mapping key by key; a field without this mark replaces the other's."""


class Given:
    """Not written in a profile: the loader gives it, or the supervisor."""

    def __get_pydantic_json_schema__(self, *_: object) -> None:
        """Keep it out of the schema."""
        from pydantic_core import PydanticOmit

        raise PydanticOmit


@dataclass(frozen=True)
class PathFromProfile:
    """A path relative to the profile that contains it."""

    is_meant: Callable[[str], bool] = bool
    """Distinguishes a path from other text that is allowed here."""


@dataclass(frozen=True, eq=False)
class Checked:
    """A value that a function looks at before its type is checked; it returns the value, or another for it."""

    check: Callable[[object], object]
    schema: Mapping[str, Any] | None = None
    """What editors are told of it, if not what its type says."""

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:  # noqa: ANN401 - pydantic's own
        from pydantic_core import core_schema

        return core_schema.no_info_before_validator_function(self.check, handler(source))

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> Any:  # noqa: ANN401 - pydantic's own
        return handler(schema) if self.schema is None else dict(self.schema)


@cache
def marked(kind: type, mark: type[M]) -> dict[str, M]:
    """Return the fields with a mark of this type, by name."""
    marks = {name: getattr(hint, "__metadata__", ()) for name, hint in get_annotations(kind, eval_str=True).items()}
    return {name: found for name, each in marks.items() for found in each if isinstance(found, mark)}


def refuse(words: Words) -> Exception:
    """Return the error with which a check of this format refuses a value."""
    from pydantic_core import PydanticCustomError

    return PydanticCustomError("deck", "{words}", {"words": words})


class Part:
    """A part of a profile: no unknown keys, no silent conversions."""

    __pydantic_config__: ClassVar[Mapping[str, object]] = {"strict": True, "extra": "forbid"}

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: Any) -> Any:  # noqa: ANN401 - pydantic's own
        """Let it be made of a mapping, strict as its fields are."""
        return {**handler(source), "strict": False}


def key(default: Any, description: str, **limits: object) -> Any:  # noqa: ANN401 - of any field
    """Return the field of a part, with what editors show, and with pydantic's limits for it."""
    metadata = {"description": description, **limits}
    if isinstance(default, dict):
        return field(default_factory=dict, metadata=metadata)
    return field(default=default, metadata=metadata)


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


_TEXTS_SCHEMA: dict[str, Any] = {
    "type": "object",
    "properties": {"en": {"type": "string"}, "ru": {"type": "string"}},
    "additionalProperties": {"type": "string"},
}
Texts = Annotated[dict[str, str], Checked(_texts, {"anyOf": [{"type": "string"}, _TEXTS_SCHEMA]})]
RosName = Annotated[str, Checked(ros_name)]
TypeName = Annotated[str, Checked(_type_name)]

"""Every interface that is installed, and each type down to its fields.

All of it may be called from any thread, and is remembered: what is installed does not change while
Deck runs.
"""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from graph.messages.fields import INTEGERS, parse, ros_name
from graph.messages.types import (
    NAME_PARTS,
    UnknownTypeError,
    load_action,
    load_message,
    load_service,
)
from graph.messages.values import fields_of, to_tree
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterator

    from graph.data import Value

KINDS = ("msg", "srv", "action")
_EXPORTED = re.compile(r"^from (\w+)\.(msg|srv|action)\._\w+ import ([^\W_]+)(?!\w)", re.MULTILINE)
"""How the generator of Python interfaces begins a line of `std_msgs/msg/__init__.py`. Names with an
underscore are the halves of services and actions."""


@dataclass(frozen=True)
class MessageField:
    """One field of a message."""

    name: str
    type_name: str
    """As .msg files write it: `float64[9]`, `string<=10`, `geometry_msgs/Point[]`."""
    default: Value
    message: str | None = None
    """The type of the message that it holds, `geometry_msgs/msg/Point`: ask for its definition."""
    least: int | None = None
    greatest: int | None = None
    """Of integers; None for all else."""
    size: int | None = None
    """Of an array of fixed length."""
    most: int | None = None
    """Greatest number of elements of a bounded array."""
    longest: int | None = None
    """Greatest number of characters of a bounded text."""


@dataclass(frozen=True)
class Constant:
    """A named value of a message: `OK = 0`."""

    name: str
    value: bool | int | float | str


@dataclass(frozen=True)
class Part:
    """Fields and constants of a message, or of one half of a service, one third of an action."""

    name: str
    """`message`; `request`, `response`; `goal`, `result`, `feedback`."""
    fields: tuple[MessageField, ...]
    constants: tuple[Constant, ...] = ()


@dataclass(frozen=True)
class Definition:
    """What a type is made of."""

    type_name: str
    parts: tuple[Part, ...]

    @property
    def kind(self) -> str:
        """`msg`, `srv` or `action`."""
        return self.type_name.split("/")[1]


@lru_cache(maxsize=1)
def interfaces() -> tuple[str, ...]:
    """Return the names of all installed types, sorted: `std_msgs/msg/Bool`.

    Of the Python packages on the path: what rclpy can use, from wheels, apt, conda and colcon.
    """
    return tuple(sorted({name for path in sys.path for name in _installed_in(Path(path))}))


@lru_cache(maxsize=512)
def definition(type_name: str) -> Definition:
    """Return what a message, a service or an action is made of. Raises UnknownTypeError."""
    parts = type_name.split("/")
    kind = parts[1] if len(parts) == NAME_PARTS else ""
    if kind == "msg":
        made: tuple[Part, ...] = (_part("message", load_message(type_name)),)
    elif kind == "srv":
        service = load_service(type_name)
        made = (_part("request", service.Request), _part("response", service.Response))
    elif kind == "action":
        action = load_action(type_name)
        names = ("goal", "result", "feedback")
        made = tuple(_part(name, getattr(action, name.capitalize())) for name in names)
    else:
        reason = say(
            "'{type}' is not the name of a type; write it as package/{kind}/Name",
            type=type_name,
            kind="msg",
        )
        raise UnknownTypeError(type_name, parts[0], reason)
    return Definition(type_name, made)


def _installed_in(folder: Path) -> Iterator[str]:
    for kind in KINDS:
        for module in folder.glob(f"*/{kind}/__init__.py"):
            package = module.parent.parent.name
            try:
                text = module.read_text(encoding="utf-8", errors="replace")
            except OSError:
                # Not for us to read, so not for rclpy either.
                continue
            for found in _EXPORTED.finditer(text):
                if found[1] == package and found[2] == kind:
                    yield f"{package}/{kind}/{found[3]}"


def _part(name: str, cls: type[Any]) -> Part:
    defaults = to_tree(cls())
    fields = [_field(field, text, defaults[field]) for field, text in fields_of(cls)]
    return Part(name, tuple(fields), tuple(_constants(cls)))


def _field(name: str, text: str, default: Value) -> MessageField:
    kind = parse(text)
    least, greatest = INTEGERS.get(kind.element, (None, None))
    return MessageField(
        name,
        ros_name(text),
        default,
        message=kind.message_type if kind.is_message else None,
        least=least,
        greatest=greatest,
        size=kind.size,
        most=kind.limit,
        longest=kind.text_limit,
    )


def _constants(cls: type[Any]) -> Iterator[Constant]:
    meta = type(cls)
    constants = vars(meta).get(f"_{meta.__name__}__constants", {})
    for name, value in constants.items():
        # A `byte` is a bytes of one in Python; numbers are what people know.
        yield Constant(name, value[0] if isinstance(value, bytes) else value)

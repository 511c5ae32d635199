"""Every installed interface, and each type down to its fields.

All functions may be called from any thread, and results are cached: what is installed does not
change while Deck runs.
"""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from graph.messages.fields import INTEGERS, fields_of, parse, ros_name, to_tree
from graph.messages.types import kind_of, load_action, load_message, load_service

if TYPE_CHECKING:
    from collections.abc import Iterator

    from graph.data import Value

KINDS = ("msg", "srv", "action")
_EXPORTED = re.compile(r"^from (\w+)\.(msg|srv|action)\._\w+ import ([^\W_]+)(?!\w)", re.MULTILINE)
"""The lines that the generator of Python interfaces writes into `std_msgs/msg/__init__.py`. Names
with an underscore are the parts of services and actions."""


@dataclass(frozen=True)
class MessageField:
    """One field of a message."""

    name: str
    type_name: str
    """As .msg files write it: `float64[9]`, `string<=10`, `geometry_msgs/Point[]`."""
    default: Value
    message: str | None = None
    """The type of the message that it holds, `geometry_msgs/msg/Point`, to pass to `definition`."""
    least: int | None = None
    greatest: int | None = None
    """Of integers; None for everything else."""


@dataclass(frozen=True)
class Constant:
    """A named value of a message: `OK = 0`."""

    name: str
    value: bool | int | float | str


@dataclass(frozen=True)
class Part:
    """Fields and constants of a message, or of one part of a service or an action."""

    name: str
    """`message`; `request`, `response`; `goal`, `result`, `feedback`."""
    fields: tuple[MessageField, ...]
    constants: tuple[Constant, ...] = ()


@dataclass(frozen=True)
class Definition:
    """The definition of a type."""

    type_name: str
    parts: tuple[Part, ...]


@lru_cache(maxsize=1)
def interfaces() -> tuple[str, ...]:
    """Return the names of all installed types, sorted: `std_msgs/msg/Bool`.

    They come from the Python packages on the path: what rclpy can use, from wheels, apt, conda and
    colcon.
    """
    return tuple(sorted({name for path in sys.path for name in _installed_in(Path(path))}))


@lru_cache(maxsize=512)
def definition(type_name: str) -> Definition:
    """Return the definition of a message, service or action. Raises UnknownTypeError."""
    kind = kind_of(type_name)
    if kind == "msg":
        return Definition(type_name, (_part("message", load_message(type_name)),))
    names = ("request", "response") if kind == "srv" else ("goal", "result", "feedback")
    whole = load_service(type_name) if kind == "srv" else load_action(type_name)
    return Definition(type_name, tuple(_part(name, getattr(whole, name.capitalize())) for name in names))


def _installed_in(folder: Path) -> Iterator[str]:
    for kind in KINDS:
        for module in folder.glob(f"*/{kind}/__init__.py"):
            package = module.parent.parent.name
            try:
                text = module.read_text(encoding="utf-8", errors="replace")
            except OSError:
                # Not readable for this user, so not for rclpy either.
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
    )


def _constants(cls: type[Any]) -> Iterator[Constant]:
    meta = type(cls)
    constants = vars(meta).get(f"_{meta.__name__}__constants", {})
    for name, value in constants.items():
        # A `byte` is a bytes object of length 1 in Python; people know it as a number.
        yield Constant(name, value[0] if isinstance(value, bytes) else value)

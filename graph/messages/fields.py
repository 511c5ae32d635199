"""The fields of messages: their types, as a class names them (`sequence<uint8, 16>`), and their values as trees."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from graph.data import Value

INTEGERS = {
    "int8": (-(2**7), 2**7 - 1),
    "uint8": (0, 2**8 - 1),
    "int16": (-(2**15), 2**15 - 1),
    "uint16": (0, 2**16 - 1),
    "int32": (-(2**31), 2**31 - 1),
    "uint32": (0, 2**32 - 1),
    "int64": (-(2**63), 2**63 - 1),
    "uint64": (0, 2**64 - 1),
    "octet": (0, 2**8 - 1),
    "char": (0, 2**8 - 1),
}
"""Least and greatest value; `octet` is ROS's `byte`."""
FLOATS = {"float": 3.4028234663852886e38, "double": 1.7976931348623157e308, "long double": 0.0}
"""Greatest finite value; 0 if it is not fixed."""
STRINGS = frozenset({"string", "wstring"})
BYTES = frozenset({"octet", "uint8", "char"})
"""Element types whose arrays are shown as bytes."""

DUMMY = "structure_needs_at_least_one_member"
"""Dummy field that the generator puts into a message without fields."""
_ROS_NAMES = {"boolean": "bool", "octet": "byte", "float": "float32", "double": "float64"}
_SEQUENCE = re.compile(r"^sequence<(?P<element>.+?)(?:, (?P<limit>\d+))?>$")
_ARRAY = re.compile(r"^(?P<element>.+)\[(?P<size>\d+)\]$")
_STRING = re.compile(r"^(?P<kind>w?string)(?:<(?P<limit>\d+)>)?$")


@dataclass(frozen=True)
class FieldType:
    """The type of one field."""

    element: str
    """`double`, `string`, `std_msgs/Header`: type of the field itself or of its elements."""
    is_many: bool = False
    size: int | None = None
    """Number of elements of a fixed-size array."""
    limit: int | None = None
    """Maximum number of elements of a bounded sequence."""
    text_limit: int | None = None
    """Maximum number of characters of a bounded string."""

    @property
    def is_message(self) -> bool:
        return "/" in self.element

    @property
    def message_type(self) -> str:
        """Full name of the type of the messages it holds: `std_msgs/msg/Header`."""
        package, _, name = self.element.partition("/")
        return f"{package}/msg/{name}"

    @property
    def is_number(self) -> bool:
        """Whether it holds integers or floats."""
        return self.element in INTEGERS or self.element in FLOATS


@lru_cache(maxsize=1024)
def parse(text: str) -> FieldType:
    """Parse the type of one field, as `get_fields_and_field_types()` of a message gives it."""
    if array := _ARRAY.match(text):
        element, limit = _text(array["element"])
        return FieldType(element, is_many=True, size=int(array["size"]), text_limit=limit)
    if sequence := _SEQUENCE.match(text):
        element, limit = _text(sequence["element"])
        most = int(sequence["limit"]) if sequence["limit"] else None
        return FieldType(element, is_many=True, limit=most, text_limit=limit)
    element, limit = _text(text)
    return FieldType(element, text_limit=limit)


def ros_name(text: str) -> str:
    """Return a field's type as .msg files write it: `float64[9]`, `uint8[<=16]`, `string<=10`."""
    kind = parse(text)
    name = _ROS_NAMES.get(kind.element, kind.element)
    if kind.text_limit is not None:
        name += f"<={kind.text_limit}"
    if not kind.is_many:
        return name
    return f"{name}[{'' if kind.limit is None else f'<={kind.limit}'}{kind.size or ''}]"


def _text(element: str) -> tuple[str, int | None]:
    found = _STRING.match(element)
    if not found:
        return element, None
    return found["kind"], int(found["limit"]) if found["limit"] else None


def to_tree(message: Any) -> dict[str, Value]:  # noqa: ANN401 - generated, without a base class
    """Return the message's fields in order, by the rules of `graph.data.Value`.

    Arrays of numbers that the message owns are not copied: do not change the message afterwards.
    """
    return {name: read(getattr(message, name)) for name, read in _readers(type(message))}  # type: ignore[arg-type]


def fields_of(cls: type[Any]) -> tuple[tuple[str, str], ...]:
    """Return names and types of a message's fields as the class has them, in order."""
    fields: dict[str, str] = cls.get_fields_and_field_types()
    return tuple((name, kind) for name, kind in fields.items() if name != DUMMY)


@lru_cache(maxsize=512)
def _readers(cls: type[Any]) -> tuple[tuple[str, Callable[[Any], Value]], ...]:
    return tuple((name, _reader(parse(kind))) for name, kind in fields_of(cls))


def _reader(kind: FieldType) -> Callable[[Any], Value]:
    if kind.is_message:
        return _read_messages if kind.is_many else to_tree
    if not kind.is_many:
        return _read_octet if kind.element == "octet" else _read_plain
    if kind.element == "octet":
        return b"".join
    if kind.element in BYTES:
        return bytes
    return _read_numbers if kind.is_number else list


def _read_plain(value: Value) -> Value:
    return value


def _read_octet(value: bytes) -> Value:
    return value[0]


def _read_messages(values: list[Any]) -> Value:
    return [to_tree(value) for value in values]


def _read_numbers(values: Any) -> Value:  # noqa: ANN401 - array.array or numpy.ndarray
    import numpy as np

    array: Value = np.asarray(values)
    return array

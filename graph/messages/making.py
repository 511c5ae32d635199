"""Converts trees of plain values, as a person types them, to messages; names what does not fit.

Of what is to be sent, `stamp: now` and `header: auto` are the time of sending, as in `ros2 topic pub` (source:
ros2cli, `ros2 topic pub --help`).
"""

from __future__ import annotations

import array
import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

from graph.messages.fields import BYTES, FLOATS, INTEGERS, STRINGS, FieldType, fields_of, parse
from graph.messages.stamps import HEADER
from graph.messages.types import load_message
from text.sentences import say
from text.suggestions import nearest, no_number
from text.yaml_faults import space_missing

if TYPE_CHECKING:
    from graph.data import Value

TIME = "builtin_interfaces/Time"
NOW, AUTO = "now", "auto"
_WORDS = {TIME: NOW, HEADER: AUTO}
_STAMP = {TIME: (), HEADER: ("stamp",)}
"""Path of the time within the field that the keyword replaces."""
NANOSECONDS_PER_S = 1_000_000_000
Path: TypeAlias = "tuple[str | int, ...]"
SHOWN = 40
"""Characters of a wrong value that an error repeats."""
ROUNDED = 1 + 2**-26
"""The shortest form of the greatest float32, 3.4028235e+38, is a little more than its value."""


class FieldError(ValueError):
    """A value does not fit its field; str() is `field: what was expected, and what was given`."""

    def __init__(self, field: str, message: str) -> None:
        """Store what is wrong with the field of this path: `header.stamp.sec`, `points[2].x`."""
        super().__init__(f"{field}: {message}" if field else message)
        self.field = field
        self.message = message
        """Made by `text.sentences.say`, so that it can be translated."""
        self.line: int | None = None
        """Place of the value in a text, counted from 1, if there is a text, as is the next."""
        self.column: int | None = None

    def __reduce__(self) -> tuple[type[FieldError], tuple[str, str], dict[str, object]]:
        """Make pickling keep all of it: what is raised in the observer's process is told here."""
        return type(self), (self.field, self.message), vars(self)


class NoSuchFieldError(FieldError):
    """There is no field with this name."""


def to_message(cls: type[Any], tree: Mapping[str, Value], field: str = "") -> Any:  # noqa: ANN401
    """Return a message of the class with these fields, the others at their defaults.

    Accepts what `to_tree` returns, and what YAML or JSON give: lists for arrays, integers for
    floats, a string for an array of bytes (its UTF-8 bytes). Raises FieldError.
    """
    if not isinstance(tree, Mapping):
        raise FieldError(field, _no_fields(tree))
    fields = dict(fields_of(cls))
    message = cls()
    before: tuple[str, object] = ("", None)
    for name, value in tree.items():
        path = f"{field}.{name}" if field else str(name)
        if name not in fields:
            _check_comma(before, name, value)
            raise NoSuchFieldError(path, no_such_field(str(name), list(fields)))
        setattr(message, name, _made(parse(fields[name]), value, path))
        before = path, value
    return message


def _no_fields(value: object) -> str:
    """Say that a value is not the fields of a message; of `x:0`, that a space is missing."""
    first = value[0] if isinstance(value, list) and value else value
    words = space_missing(first) if isinstance(first, str) else None
    return words or say("expected fields by name, got {value}", value=shown(value))


def _check_comma(before: tuple[str, object], name: object, value: object) -> None:
    """Explain `{x: 0,5}`, which YAML reads as `x: 0` and a field `5`."""
    path, whole = before
    if value is None and type(whole) is int and str(name).isdigit():
        raise FieldError(path, no_number(f"{whole},{name}", ""))


def no_such_field(name: str, names: list[str]) -> str:
    """Say that none of these has this name, or which one may be meant."""
    if meant := nearest(name, names):
        return say("no such field; did you mean {name}?", name=meant)
    if not names:
        return say("it has no fields at all")
    return say("no such field; there is {names}", names=", ".join(names))


def _made(kind: FieldType, value: Value, path: str) -> object:
    if kind.is_many:
        return _many(kind, value, path)
    if kind.element == "octet":
        return bytes([_octet(value, path)])
    return one_made(kind, value, path)


def one_made(kind: FieldType, value: Value, path: str) -> object:
    """Return a value for a field that is no list, or for an element of one. Raises FieldError."""
    if kind.is_message:
        return to_message(load_message(kind.message_type), value, path)  # type: ignore[arg-type]
    if kind.element in STRINGS:
        return _text(kind, value, path)
    if kind.element == "boolean":
        return _boolean(value, path)
    if kind.element in FLOATS:
        return _float(kind.element, value, path)
    return _integer(kind.element, value, path)


def _many(kind: FieldType, value: Value, path: str) -> object:
    if isinstance(value, str) and kind.element in BYTES:
        value = _encoded(value, path)
    if isinstance(value, (bytes, bytearray, memoryview)) and kind.element in BYTES:
        _check_length(kind, len(value), path)
        return _packed(kind, value)
    if not hasattr(value, "__len__") or isinstance(value, (str, bytes, Mapping)):
        raise FieldError(path, say("expected a list, got {value}", value=shown(value)))
    elements: Sequence[Value] = value  # type: ignore[assignment]
    _check_length(kind, len(elements), path)
    if kind.is_number and _fits_as_it_is(kind, elements):
        return elements
    made = [one_made(kind, _plain(each), f"{path}[{i}]") for i, each in enumerate(elements)]
    return _packed(kind, bytes(made)) if kind.element == "octet" else made  # type: ignore[arg-type]


def _fits_as_it_is(kind: FieldType, elements: object) -> bool:
    """Return whether this is exactly the array that rclpy itself would hold, so needs no checks."""
    dtype = getattr(elements, "dtype", None)
    return kind.size is not None and dtype is not None and dtype.name == _DTYPES.get(kind.element)


_DTYPES = {"float": "float32", "double": "float64"} | {
    name: name for name in INTEGERS if name not in {"octet", "char"}
}


def _plain(value: Any) -> Any:  # noqa: ANN401 - a numpy number, or a value
    return value.item() if hasattr(value, "item") else value


def _packed(kind: FieldType, value: bytes | bytearray | memoryview) -> object:
    if kind.element == "octet":
        return [bytes([each]) for each in value]
    return array.array("B", value) if kind.size is None else list(value)


def _check_length(kind: FieldType, length: int, path: str) -> None:
    if kind.size is not None and length != kind.size:
        raise FieldError(path, say("expected {n} elements, got {length}", n=kind.size, length=length))
    if kind.limit is not None and length > kind.limit:
        raise FieldError(path, say("expected at most {n} elements, got {length}", n=kind.limit, length=length))


def _text(kind: FieldType, value: Value, path: str) -> str:
    if isinstance(value, (bool, int, float)):
        words = say("expected a string, got {value}: put it in quotes", value=shown(value))
        raise FieldError(path, words)
    if not isinstance(value, str):
        raise FieldError(path, say("expected a string, got {value}", value=shown(value)))
    if kind.text_limit is not None and len(value) > kind.text_limit:
        raise FieldError(
            path, say("expected at most {n} characters, got {length}", n=kind.text_limit, length=len(value))
        )
    if "\0" in value:
        raise FieldError(path, say("a ROS string cannot hold the character NUL"))
    _encoded(value, path)
    return value


def _encoded(value: str, path: str) -> bytes:
    try:
        return value.encode()
    except UnicodeEncodeError as error:
        raise FieldError(path, say("{value} is not valid Unicode", value=shown(value))) from error


def _boolean(value: Value, path: str) -> bool:
    if not isinstance(value, bool):
        raise FieldError(path, say("expected true or false, got {value}", value=shown(value)))
    return value


def _float(element: str, value: Value, path: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise FieldError(path, no_number(value, shown(value)))
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    greatest = FLOATS[element]
    if (isinstance(value, int) and math.isinf(number)) or (
        math.isfinite(number) and 0 < greatest * ROUNDED < abs(number)
    ):
        raise FieldError(path, say("{value} is too large for a {type}", value=shown(value), type=element))
    is_rounded = math.isfinite(number) and 0 < greatest < abs(number)
    return math.copysign(greatest, number) if is_rounded else number


def _integer(element: str, value: Value, path: str) -> int:
    least, greatest = INTEGERS[element]
    whole = isinstance(value, int) or (isinstance(value, float) and value.is_integer())
    if isinstance(value, bool) or not whole:
        raise FieldError(path, say("expected a whole number, got {value}", value=shown(value)))
    number = int(value)  # type: ignore[arg-type]
    if not least <= number <= greatest:
        raise FieldError(
            path,
            say("expected {least} to {greatest}, got {value}", least=least, greatest=greatest, value=shown(value)),
        )
    return number


def _octet(value: Value, path: str) -> int:
    if isinstance(value, bytes) and len(value) == 1:
        return value[0]
    return _integer("octet", value, path)


def shown(value: object) -> str:
    """Return a wrong value as an error repeats it."""
    if value is None:
        return say("nothing")
    text = repr(value)
    return text if len(text) <= SHOWN else text[: SHOWN - 1] + "…"


@dataclass(frozen=True, slots=True)
class Draft:
    """A message to be sent, once or periodically."""

    message: Any
    stamps: tuple[Path, ...] = ()
    """The fields that hold the time of sending."""

    def dated(self) -> Any:  # noqa: ANN401 - generated, no base class
        """Return the message as it should be sent at this moment."""
        seconds, nanoseconds = divmod(time.time_ns(), NANOSECONDS_PER_S)
        for path in self.stamps:
            field = self.message
            for step in path:
                field = field[step] if isinstance(step, int) else getattr(field, step)
            field.sec, field.nanosec = seconds, nanoseconds
        return self.message


def draft(cls: type[Any], tree: Mapping[str, Value]) -> Draft:
    """Return a message of the class with these fields, as `to_message` does, with the two keywords.

    Raises FieldError.
    """
    stamps: list[Path] = []
    return Draft(to_message(cls, _without_words(cls, tree, (), stamps)), tuple(stamps))


def with_words(cls: type[Any], tree: Mapping[str, Value]) -> dict[str, Value]:
    """Return the tree with `now` as the stamp of every header that is not in an array."""
    shown: dict[str, Value] = dict(tree)
    for name, text in fields_of(cls):
        kind = parse(text)
        value = tree[name]
        if kind.is_message and not kind.is_many and isinstance(value, Mapping):
            if kind.element == HEADER:
                shown[name] = {**value, "stamp": NOW}
            else:
                shown[name] = with_words(_class_of(kind), value)
    return shown


def _without_words(
    cls: type[Any],
    tree: Any,  # noqa: ANN401 - whatever was typed; errors are reported when the message is made
    path: Path,
    stamps: list[Path],
) -> Any:  # noqa: ANN401
    if not isinstance(tree, Mapping):
        return tree
    fields = dict(fields_of(cls))
    plain = dict(tree)
    for name, value in tree.items():
        kind = parse(fields[name]) if name in fields else None
        if kind is None or not kind.is_message:
            continue
        if kind.is_many and isinstance(value, list):
            plain[name] = [
                _without_word(kind, each, (*path, name, index), stamps) for index, each in enumerate(value)
            ]
        elif not kind.is_many:
            plain[name] = _without_word(kind, value, (*path, name), stamps)
    return plain


def _without_word(kind: FieldType, value: Value, path: Path, stamps: list[Path]) -> Any:  # noqa: ANN401
    if isinstance(value, str) and value == _WORDS.get(kind.element):
        stamps.append((*path, *_STAMP[kind.element]))
        return {}
    return _without_words(_class_of(kind), value, path, stamps)


def _class_of(kind: FieldType) -> type[Any]:
    found: type[Any] = load_message(kind.message_type)
    return found

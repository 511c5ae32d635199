"""Messages from the YAML of a command line, with the real tool's liberties and errors."""

from __future__ import annotations

import array
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import yaml

from ros2.naming import load

if TYPE_CHECKING:
    from collections.abc import Callable

Stamp = Any
"""A `builtin_interfaces/msg/Time`."""


def read(text: str) -> dict[str, Any] | None:
    """Return the fields that a text in YAML has; None if it is something else."""
    try:
        values = yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise RuntimeError(f"The passed value is not YAML: {error}") from error
    return values if isinstance(values, dict) else None


def fill(message: Any, values: Any) -> list[Callable[[Stamp], None]]:  # noqa: ANN401 - generated
    """Set fields; return what sets the stamps that are to be the time of each publishing.

    Raises what the message raises for a field or a value that it does not have.
    """
    stamps: list[Callable[[Stamp], None]] = []
    _fill(message, values, stamps)
    return stamps


def _fill(message: Any, values: Any, stamps: list[Callable[[Stamp], None]]) -> None:  # noqa: ANN401
    if not isinstance(values, dict):
        kind = type(values).__name__
        raise TypeError(f"Value '{values}' is expected to be a dictionary but is a {kind}")
    kinds = dict(zip(message.get_fields_and_field_types(), message.SLOT_TYPES, strict=False))
    for name, given in values.items():
        now = getattr(message, name)
        if given == "auto" and _is(now, "std_msgs.msg._header.Header"):
            stamps.append(partial(setattr, now, "stamp"))
        elif given == "now" and _is(now, "builtin_interfaces.msg._time.Time"):
            stamps.append(partial(setattr, message, name))
        else:
            setattr(message, name, _value(now, given, kinds.get(name), stamps))


def _is(value: object, class_name: str) -> bool:
    kind = type(value)
    return f"{kind.__module__}.{kind.__qualname__}" == class_name


def _value(now: Any, given: Any, kind: Any, stamps: list[Callable[[Stamp], None]]) -> Any:  # noqa: ANN401
    if isinstance(now, array.array):
        return array.array(now.typecode, given)
    if isinstance(now, np.ndarray):
        return np.array(given, dtype=now.dtype)
    if isinstance(now, list) and hasattr(kind, "value_type"):
        return _list(given, kind.value_type, stamps)
    if type(given) is type(now):
        return given
    try:
        return bytes([given]) if isinstance(now, bytes) else type(now)(given)
    except TypeError:
        value = type(now)()
        _fill(value, given, stamps)
        return value


def _list(given: Any, element: Any, stamps: list[Callable[[Stamp], None]]) -> list[Any]:  # noqa: ANN401
    if hasattr(element, "namespaces"):
        cls = load("/".join(element.namespaced_name()), "msg")
        made = []
        for each in given:
            message = cls()
            _fill(message, each, stamps)
            made.append(message)
        return made
    if getattr(element, "typename", "") == "octet":
        return [bytes([each]) if isinstance(each, int) else each for each in given]
    return list(given)

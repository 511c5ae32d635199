"""Parameter values: as ROS transports them, as plain values, and as a person types them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from graph.data import ParameterRow
from text.sentences import say
from text.suggestions import no_number
from text.yaml_scalars import meaning

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from graph.data import Value

TYPES = (
    "not_set",
    "bool",
    "integer",
    "double",
    "string",
    "byte_array",
    "bool_array",
    "integer_array",
    "double_array",
    "string_array",
)
"""By their numbers (source: rcl_interfaces/msg/ParameterType)."""
INTEGERS = range(-(2**63), 2**63)
SHOWN = 40
"""Characters of a wrong value that an error repeats."""


class WrongValueError(ValueError):
    """A value does not fit its parameter; `words` and str() say what was expected and given."""

    def __init__(self, words: str) -> None:
        """Store the reason, made by `text.sentences.say`."""
        super().__init__(words)
        self.words = words


def row(name: str, descriptor: Mapping[str, Any], carried: Mapping[str, Any] | None) -> ParameterRow:
    """Return one parameter from the trees of its ParameterDescriptor and its ParameterValue.

    A parameter that was declared but never given a value has its declared type and no value.
    """
    value = plain(carried) if carried is not None else None
    type_name = TYPES[carried["type"]] if carried is not None and value is not None else ""
    ranges = [*descriptor["floating_point_range"], *descriptor["integer_range"]]
    least, greatest, step = (
        (float(ranges[0]["from_value"]), float(ranges[0]["to_value"]), float(ranges[0]["step"]))
        if ranges
        else (None, None, None)
    )
    return ParameterRow(
        name,
        type_name or type_of(descriptor),
        value,
        descriptor["description"],
        descriptor["additional_constraints"],
        descriptor["read_only"],
        least,
        greatest,
        step or None,
    )


def type_of(descriptor: Mapping[str, Any]) -> str:
    """Return the type that a parameter was declared with; `not_set` if any type will do."""
    number = descriptor["type"]
    return TYPES[number] if number in range(len(TYPES)) else TYPES[0]


def plain(carried: Mapping[str, Any]) -> Value | None:
    """Return the plain value that the tree of a ParameterValue carries; None if it has none."""
    number = carried["type"]
    if number not in range(1, len(TYPES)):
        return None
    value: Value = carried[f"{TYPES[number]}_value"]
    return value.tolist() if hasattr(value, "tolist") else value


def carried(type_name: str, value: Value) -> dict[str, Value]:
    """Return the tree of the ParameterValue of this type for a value that a person gave.

    An integer is accepted for a double, and the text of a value for the value. For `not_set` the
    type is that of the value. Raises WrongValueError if it does not fit.
    """
    if type_name == TYPES[0]:
        type_name = _type_for(value)
    made = _READERS[type_name](value)
    return {"type": TYPES.index(type_name), f"{type_name}_value": made}


def _type_for(value: Value) -> str:
    if isinstance(value, (bytes, bytearray)):
        return "byte_array"
    for kind, name in ((bool, "bool"), (int, "integer"), (float, "double"), (str, "string")):
        if isinstance(value, kind):
            return name
    elements = _elements(value)
    if not elements:
        raise WrongValueError(say("an empty list has no type, and the parameter has none either"))
    names = {_type_for(each) for each in elements}
    if names == {"integer", "double"}:
        return "double_array"
    if len(names) > 1 or f"{min(names)}_array" not in TYPES:
        raise WrongValueError(say("expected a list of values of one type, got {value}", value=_shown(value)))
    return f"{names.pop()}_array"


def _bool(value: Value) -> bool:
    meant = _meant(value)
    if not isinstance(meant, bool):
        raise WrongValueError(say("expected true or false, got {value}", value=_shown(value)))
    return meant


def _integer(value: Value) -> int:
    number = _meant(value)
    if isinstance(number, float) and number.is_integer():
        number = int(number)
    if isinstance(number, bool) or not isinstance(number, int):
        raise WrongValueError(say("expected a whole number, got {value}", value=_shown(value)))
    if number not in INTEGERS:
        raise WrongValueError(say("{value} is too large for a 64-bit integer", value=_shown(value)))
    return number


def _double(value: Value) -> float:
    meant = _meant(value)
    if isinstance(meant, bool) or not isinstance(meant, (int, float)):
        raise WrongValueError(no_number(value, _shown(value)))
    try:
        return float(meant)
    except OverflowError:
        raise WrongValueError(say("{value} is too large for a double", value=_shown(value))) from None


def _meant(value: Value) -> Value | None:
    """Return a single value; text that was typed means what it would mean in YAML."""
    return meaning(value.strip()) if isinstance(value, str) else value


def _string(value: Value) -> str:
    if isinstance(value, (bool, int, float)):
        words = say("expected a string, got {value}: put it in quotes", value=_shown(value))
        raise WrongValueError(words)
    if not isinstance(value, str):
        raise WrongValueError(say("expected a string, got {value}", value=_shown(value)))
    if "\0" in value:
        raise WrongValueError(say("a ROS string cannot hold the character NUL"))
    try:
        value.encode()
    except UnicodeEncodeError:
        raise WrongValueError(say("{value} is not valid Unicode", value=_shown(value))) from None
    return value


def _bytes(value: Value) -> bytes:
    if isinstance(value, (bytes, bytearray)):
        return bytes(value)
    numbers = [_integer(each) for each in _elements(value)]
    if not all(0 <= number <= 255 for number in numbers):
        raise WrongValueError(say("expected bytes, 0 to 255, got {value}", value=_shown(value)))
    return bytes(numbers)


def _list_of(one: Callable[[Value], Value]) -> Callable[[Value], Value]:
    return lambda value: [one(each) for each in _elements(value)]


def _elements(value: Value) -> list[Value]:
    if isinstance(value, str):
        value = _parsed(value)
    if hasattr(value, "tolist"):
        value = value.tolist()
    if not isinstance(value, (list, tuple)):
        raise WrongValueError(say("expected a list, such as [1, 2], got {value}", value=_shown(value)))
    return list(value)


def _parsed(text: str) -> Value:
    from graph.messages.yaml_text import value_of
    from text.yaml_faults import YamlError

    try:
        value: Value = value_of(text)
    except YamlError as error:
        if text.lstrip().startswith("["):
            raise WrongValueError(error.message) from None
        return text
    return value


def _shown(value: object) -> str:
    if value is None:
        return say("nothing")
    text = repr(value)
    return text if len(text) <= SHOWN else text[: SHOWN - 1] + "…"


_READERS: dict[str, Callable[[Value], Value]] = {
    "bool": _bool,
    "integer": _integer,
    "double": _double,
    "string": _string,
    "byte_array": _bytes,
    "bool_array": _list_of(_bool),
    "integer_array": _list_of(_integer),
    "double_array": _list_of(_double),
    "string_array": _list_of(_string),
}

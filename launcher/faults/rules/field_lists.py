"""Messages: fields that are lists, and what does not go into one."""

from __future__ import annotations

import array
import re
from collections.abc import Iterator, Sequence
from collections.abc import Set as AbstractSet
from typing import TYPE_CHECKING, Any, NamedTuple

from launcher.faults.failure import Failure, fields_of, is_from, is_message, name_of
from launcher.faults.remedy import is_none_here, parameter
from launcher.faults.rules.conversions import each_of, first_fitting, listing, of_array, takes
from text.sentences import Words, say

if TYPE_CHECKING:
    from launcher.faults.rules.conversions import Way

LIST = re.compile(r"sequence<(?P<of>.+?)(?:, (?P<most>\d+))?>|(?P<fixed>.+)\[(?P<count>\d+)\]")
FLOATS = ("double", "float")
TEXTS = ("string", "wstring")
BITS = re.compile(r"(u?)int(\d+)")


class FieldSlot(NamedTuple):
    """A field of a class of messages."""

    kind: Any
    """The class of messages."""
    name: str
    of: str
    """Its type, as ROS writes it."""

    def takes(self, value: Any) -> bool:  # noqa: ANN401
        return takes(self.kind, self.name, value)

    def first_fitting(self, ways: Iterator[Way]) -> str:
        """Return the first expression whose value it takes, empty if there is none."""
        return first_fitting(self.kind, self.name, ways)

    def is_given(self, what: str, value: Any) -> Words:  # noqa: ANN401
        """Say of which type the field is, and of which the value."""
        return say(
            "The field {field} is of type {type}, and {what} is of type {given}.",
            field=self.name,
            type=self.of,
            what=what,
            given=name_of(type(value)),
        )


def hollow(failure: Failure) -> Words | None:
    """A list of messages that is published has one of another type in it."""
    inner = failure.inner
    if inner is None or inner.function != "publish" or not inner.is_in("rclpy", "publisher"):
        return None
    message = inner.values.get("msg")
    return _hollow(message) if is_message(message) else None


def _hollow(message: Any) -> Words | None:  # noqa: ANN401
    for name, of in fields_of(message).items():
        value, parts = getattr(message, name), LIST.fullmatch(of)
        if parts is not None and isinstance(value, (list, tuple)):
            words = _value_in_list(FieldSlot(type(message), name, of), parts["of"] or parts["fixed"], list(value))
        else:
            words = _hollow(value) if is_message(value) else None
        if words is not None:
            return words
    return None


def value_of_list(
    field: FieldSlot,
    what: str,
    parts: re.Match[str],
    value: Any,  # noqa: ANN401
) -> Words | None:
    """Say why a field that is a list does not take this value."""
    of = parts["of"] or parts["fixed"]
    if not is_listlike(value) or isinstance(value, dict):
        return _no_list(field, what, parts, value)
    is_array = _is_of_numpy(value)
    count = value.size if is_array else len(value)
    rows = [] if is_array else list(value)
    if rows and is_listlike(rows[0]):
        return _number(field, of, rows, 0)
    if parts["count"] and count != int(parts["count"]):
        return say(
            "The field {field} has {count} values, always; this list has {given}.",
            field=field.name,
            count=int(parts["count"]),
            given=count,
        )
    if parts["most"] and count > int(parts["most"]):
        return say(
            "The field {field} has {count} values at most; this list has {given}.",
            field=field.name,
            count=int(parts["most"]),
            given=count,
        )
    if is_array:
        return _array(field, what, of, value)
    if isinstance(value, array.array):
        return _typed(field, what, of, value)
    if isinstance(value, range) and of in FLOATS:
        return say("The values of {field} are floats: [float(v) for v in {what}].", field=field.name, what=what)
    return _value_in_list(field, of, list(value))


def _is_of_numpy(value: object) -> bool:
    return type(value).__module__.partition(".")[0] == "numpy"


def _array(field: FieldSlot, what: str, of: str, value: Any) -> Words:  # noqa: ANN401
    """Say what makes of an array of numpy what the field takes."""
    made = field.first_fitting(of_array(what, value, of))
    if not made:
        return say(
            "The values of {field} are of type {type}; {what} is an array with the shape {shape}"
            " and the type {dtype}.",
            field=field.name,
            type=of,
            what=what,
            shape=str(value.shape),
            dtype=str(value.dtype),
        )
    if made.endswith(".tobytes()"):
        return say(
            "The field {field} takes bytes: {made}. CvBridge().cv2_to_imgmsg(…) makes a whole Image of an array.",
            field=field.name,
            made=made,
        )
    return say("The field {field} takes a list, not an array of numpy: {made}.", field=field.name, made=made)


def _typed(field: FieldSlot, what: str, of: str, value: Any) -> Words | None:  # noqa: ANN401
    """Say what an `array.array` of another type is converted by."""
    if not field.takes(value.tolist()):
        return _value_in_list(field, of, value.tolist())
    return say(
        "The values of {field} are of type {type}: {what}.tolist() makes a list of them that is converted.",
        field=field.name,
        type=of,
        what=what,
    )


def _no_list(
    field: FieldSlot,
    what: str,
    parts: re.Match[str],
    value: Any,  # noqa: ANN401
) -> Words | None:
    of = parts["of"] or parts["fixed"]
    if isinstance(value, str) and of == "octet":
        return say(
            "The field {field} is a list of single bytes: [bytes([b]) for b in {what}.encode()].",
            field=field.name,
            what=what,
        )
    if isinstance(value, str) and of == "uint8":
        return say(
            "The field {field} is a list of bytes, and {what} a text: list({what}.encode()).",
            field=field.name,
            what=what,
        )
    if is_from(value, "rclpy", "Parameter"):
        return parameter(what)
    if value is None:
        return is_none_here(what)
    if isinstance(value, Iterator):
        return say("The field {field} is a list, which list({what}) makes.", field=field.name, what=what)
    made = field.first_fitting(listing(what, value, int(parts["count"] or 1)))
    if made:
        return say("The field {field} is a list: write {made}.", field=field.name, made=made)
    return say(
        "The field {field} is a list of values of type {type}, and {what} is of type {given}.",
        field=field.name,
        type=of,
        what=what,
        given=name_of(type(value)),
    )


def _value_in_list(field: FieldSlot, of: str, values: list[Any]) -> Words | None:
    for index, value in enumerate(values):
        words = _unfit(field, of, values, index, value)
        if words is not None:
            return words
    return None


def _unfit(
    field: FieldSlot,
    of: str,
    values: list[Any],
    index: int,
    value: Any,  # noqa: ANN401
) -> Words | None:
    """Say why one value does not go into a list; None if it does."""
    bits = BITS.fullmatch(of)
    if bits and isinstance(value, int):
        return _beyond(field.name, bits, index, value)
    if of == "octet" and not isinstance(value, bytes):
        return say("The field {field} is a list of single bytes: [bytes([b]) for b in data].", field=field.name)
    if of == "boolean" and not isinstance(value, bool):
        return say("The values of {field} are True or False.", field=field.name)
    if "/" in of and isinstance(value, type):
        return say("{what} is a class: the brackets are missing, {what}().", what=value.__name__)
    if "/" in of and not (is_message(value) and type(value).__name__ == of.rpartition("/")[2]):
        return say(
            "The values of {field} are messages {type}; the one at [{index}] is {given}.",
            field=field.name,
            type=of,
            index=index,
            given=name_of(value if isinstance(value, type) else type(value)),
        )
    if (of in FLOATS and not isinstance(value, float)) or bits:
        return _number(field, of, values, index)
    if of in TEXTS and not isinstance(value, str):
        return say("The values of {field} are texts: [str(v) for v in …].", field=field.name)
    return None


def _beyond(name: str, bits: re.Match[str], index: int, value: int) -> Words | None:
    low, high = range_of(bits)
    if low <= value <= high:
        return None
    return say(
        "The values of {field} are {low} to {high}; the one at [{index}] is {value}.",
        field=name,
        low=low,
        high=high,
        index=index,
        value=value,
    )


def _number(field: FieldSlot, of: str, values: list[Any], index: int) -> Words:
    """Say what makes a list of numbers of such values, if anything does."""
    made, value = field.first_fitting(each_of(values)), values[index]
    if not made or (is_listlike(value) and "row" not in made):
        return say(
            "The values of {field} are of type {type}; the one at [{index}] is {value}.",
            field=field.name,
            type=of,
            index=index,
            value=repr(value),
        )
    if "row" in made:
        return say("The field {field} is one flat list: {made}.", field=field.name, made=made)
    if of in FLOATS:
        return say("The values of {field} are floats: write 1.0, not 1, or [float(v) for v in …].", field=field.name)
    return say("The values of {field} are whole numbers: [int(v) for v in …].", field=field.name)


def range_of(bits: re.Match[str]) -> tuple[int, int]:
    """Return the least and the largest value of a type such as uint8."""
    size = int(bits[2])
    return (0, 2**size - 1) if bits[1] else (-(2 ** (size - 1)), 2 ** (size - 1) - 1)


def is_listlike(value: Any) -> bool:  # noqa: ANN401
    """Whether it holds several values, and is not a text."""
    if _is_of_numpy(value):
        return hasattr(value, "size") and getattr(value, "shape", ()) != ()
    return isinstance(value, (Sequence, AbstractSet, dict, array.array)) and not isinstance(value, str)

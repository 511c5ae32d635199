"""Messages: values that a field does not take, and what is published."""

from __future__ import annotations

import array
import ast
import inspect
import re
from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from typing import Any

from launcher.faults.failure import (
    Failure,
    fields_of,
    is_from,
    is_message,
    is_message_class,
    is_service_class,
    name_of,
    shown,
)
from launcher.faults.remedy import future, is_none_here, of_message, parameter
from text.sentences import Words, say

_LIST = re.compile(r"sequence<(?P<of>.+?)(?:, (?P<most>\d+))?>|(?P<fixed>.+)\[(?P<count>\d+)\]")
_FLOATS = ("double", "float")
_TEXTS = ("string", "wstring")
_BITS = re.compile(r"(u?)int(\d+)")


def field_value(failure: Failure) -> Words | None:
    """A field was given a value that it does not take; the setter of the message knows both."""
    inner = failure.inner
    if not isinstance(failure.error, AssertionError) or inner is None:
        return None
    message, name = inner.values.get("self"), inner.function
    if "value" not in inner.values or not is_message(message):
        return None
    of = fields_of(message).get(name)
    if of is None:
        return None
    value, node = inner.values["value"], _given(failure, name)
    what = shown(node) or "x"
    parts = _LIST.fullmatch(of)
    if parts is not None:
        return _list(name, what, parts, value)
    if "/" in of:
        return _message(message, name, what, of, value)
    return _one(name, what, of, value)


def hollow(failure: Failure) -> Words | None:
    """A list of messages that is published has one of another type in it."""
    inner = failure.inner
    if inner is None or inner.function != "publish" or not inner.is_in("rclpy", "publisher"):
        return None
    message = inner.values.get("msg")
    return _hollow(message) if is_message(message) else None


def _hollow(message: Any) -> Words | None:  # noqa: ANN401
    for name, of in fields_of(message).items():
        value, parts = getattr(message, name), _LIST.fullmatch(of)
        if parts is not None and isinstance(value, (list, tuple)):
            words = _value_in_list(name, parts["of"] or parts["fixed"], list(value))
        else:
            words = _hollow(value) if is_message(value) else None
        if words is not None:
            return words
    return None


def not_made(failure: Failure) -> Words | None:
    """A service or an action is not made; its request or goal is."""
    if not isinstance(failure.error, NotImplementedError):
        return None
    for call in failure.all(ast.Call):
        kind = failure.value(call.func)
        inner = "Request" if is_service_class(kind) else "Goal" if hasattr(kind, "Goal") else ""
        if inner:
            return say(
                "{type} is only the pair of what is asked and answered; make"
                " {type}.{inner}(), or the other part of it.",
                type=shown(call.func),
                inner=inner,
            )
    return None


def sent(failure: Failure) -> Words | None:
    """`publish`, `call_async` and `send_goal_async` were given something of another type."""
    inner = failure.inner
    if not isinstance(failure.error, TypeError) or inner is None or not inner.is_in("rclpy"):
        return None
    values = inner.values
    if inner.function == "publish" and inner.is_in("rclpy", "publisher"):
        return _published(failure, values["msg"], values["self"].msg_type)
    if inner.function in ("call", "call_async") and inner.is_in("rclpy", "client"):
        if "request" not in values:
            return None
        service = values["self"].srv_type
        return _asked(failure, values["request"], service, service.Request)
    if inner.function in ("send_goal", "send_goal_async") and "goal" in values:
        action = values["self"]._action_type  # noqa: SLF001 - nobody else knows it
        return _asked(failure, values["goal"], action, action.Goal)
    return None


def _published(failure: Failure, value: Any, kind: Any) -> Words | None:  # noqa: ANN401
    what, name = _argument(failure, "publish"), name_of(kind)
    if value is kind:
        return no_brackets(what, name)
    if value is None:
        return is_none_here(what)
    if is_message(value) and name_of(type(value)) == name:
        return say(
            "There are two types {type}: {what} is the one of {given}, and the topic has the one"
            " of {wanted}. Import the right one.",
            type=name,
            what=what,
            given=type(value).__module__.partition(".")[0],
            wanted=kind.__module__.partition(".")[0],
        )
    if is_message(value):
        return say(
            "This publisher was made for {wanted}, and is given {given}.",
            wanted=name,
            given=name_of(type(value)),
        )
    if _suits(fields_of(kind).get("data", ""), value):
        return say(
            "publish takes a whole message: self.pub.publish({type}(data={what})).",
            type=name,
            what=what,
        )
    return say("publish takes a whole message of type {type}, not {what}.", type=name, what=what)


def _suits(of: str, value: Any) -> bool:  # noqa: ANN401
    """Whether a field of this type may be what a value was meant for."""
    if of in _FLOATS or _BITS.fullmatch(of):
        return isinstance(value, (int, float))
    if of in _TEXTS:
        return not _is_listlike(value)
    return of == "boolean" or (_LIST.fullmatch(of) is not None and isinstance(value, (list, tuple)))


def _asked(failure: Failure, value: Any, pair: Any, wanted: Any) -> Words | None:  # noqa: ANN401
    what, name = (
        _argument(failure, "call", "call_async", "send_goal", "send_goal_async"),
        name_of(wanted),
    )
    part = f"{pair.__name__}.{name.rpartition('.')[2]}"
    if value is wanted:
        return no_brackets(what, part)
    return say(
        "A call takes a request of type {type}: make one, {type}(), fill it, and hand it over.",
        type=part,
    )


def no_brackets(what: str, kind: str) -> Words:
    """Say that a class was taken for an object of it."""
    return say(
        "{what} is the class {type} itself: with brackets, {type}(), a message is made of it.",
        what=what,
        type=kind,
    )


def _argument(failure: Failure, *names: str) -> str:
    for call in failure.all(ast.Call):
        if isinstance(call.func, ast.Attribute) and call.func.attr in names and call.args:
            return shown(call.args[0])
    return "x"


def _given(failure: Failure, field: str) -> ast.AST | None:
    """Return the expression that the field was given."""
    if failure.own is None:
        return None
    made = len(failure.levels) > 1 and failure.levels[-2].function == "__init__"
    for call in failure.all(ast.Call) if made else ():
        for keyword in call.keywords:
            if keyword.arg == field:
                return keyword.value
    statement = failure.statement
    if isinstance(statement, (ast.Assign, ast.AugAssign, ast.AnnAssign)):
        return statement.value
    return None


def _one(name: str, what: str, of: str, value: Any) -> Words | None:  # noqa: ANN401
    """Say why a field that holds one value does not take this one."""
    unsuitable = _unsuitable(what, value)
    if unsuitable is not None:
        return unsuitable
    if of in _FLOATS:
        return _float(name, what, of, value)
    if of in _TEXTS:
        return _text(name, what, value)
    if of == "boolean" and isinstance(value, str):
        return say("The field {field} is True or False, without quotes.", field=name)
    if of == "boolean":
        return say("The field {field} is True or False: bool({what}).", field=name, what=what)
    if of == "octet":
        return say("The field {field} is a single byte: bytes([{what}]).", field=name, what=what)
    bits = _BITS.fullmatch(of)
    return _whole(name, what, bits, value) if bits else None


def _float(name: str, what: str, of: str, value: Any) -> Words:  # noqa: ANN401
    if isinstance(value, float):
        return say(
            "The field {field} is a {type}, and {value:g} is too large for it.",
            field=name,
            type="float32" if of == "float" else "float64",
            value=value,
        )
    if isinstance(value, (int, str)) and re.fullmatch(r"-?\d+", what):
        return say(
            "The field {field} is a float: write {value}.0, not {value}.", field=name, value=what
        )
    if _is_listlike(value):
        return say(
            "The field {field} is one number, and {what} is many: choose one, {what}[0].",
            field=name,
            what=what,
        )
    return say("The field {field} is a float: write float({what}).", field=name, what=what)


def _text(name: str, what: str, value: Any) -> Words:  # noqa: ANN401
    if isinstance(value, (bytes, bytearray)):
        return say(
            "The field {field} is a text, and {what} are bytes: {what}.decode().",
            field=name,
            what=what,
        )
    return say("The field {field} is a text: write str({what}).", field=name, what=what)


def _whole(name: str, what: str, bits: re.Match[str], value: Any) -> Words:  # noqa: ANN401
    low, high = _range(bits)
    if isinstance(value, int) and not low <= value <= high:
        return say(
            "The field {field} holds {low} to {high}; {value} does not fit.",
            field=name,
            low=low,
            high=high,
            value=value,
        )
    if isinstance(value, float):
        return say(
            "The field {field} is a whole number: int({what}) cuts the fraction off, round({what})"
            " rounds.",
            field=name,
            what=what,
        )
    if _is_listlike(value):
        return say(
            "The field {field} is one number, and {what} is many: choose one, {what}[0].",
            field=name,
            what=what,
        )
    return say("The field {field} is a whole number: write int({what}).", field=name, what=what)


def _range(bits: re.Match[str]) -> tuple[int, int]:
    size = int(bits[2])
    return (0, 2**size - 1) if bits[1] else (-(2 ** (size - 1)), 2 ** (size - 1) - 1)


def _unsuitable(what: str, value: Any) -> Words | None:  # noqa: ANN401
    """Say what is wrong with a value that fits no field of a single value."""
    if value is None:
        return is_none_here(what)
    if is_from(value, "rclpy", "Parameter"):
        return parameter(what)
    if is_from(value, "rclpy", "Future", "Task"):
        return future(what)
    if is_message(value):
        return of_message(what, type(value))
    if inspect.isroutine(value):
        return say("{what} is a function: the brackets are missing, {what}().", what=what)
    return None


def _message(message: Any, name: str, what: str, of: str, value: Any) -> Words:  # noqa: ANN401
    """Say why a field that is a message does not take this value."""
    kind = of.rpartition("/")[2]
    if is_message_class(value) and value.__name__ == kind:
        return no_brackets(what, kind)
    if is_from(value, "rclpy", "Time", "Duration"):
        return say(
            "The field {field} is a message, and {what} is of type {type} of rclpy: {what}.to_msg()"
            " makes the message.",
            field=name,
            type=kind,
            what=what,
        )
    if of in ("builtin_interfaces/Time", "builtin_interfaces/Duration"):
        return say(
            "The field {field} is a message of type {type}. The time now is"
            " self.get_clock().now().to_msg().",
            field=name,
            type=kind,
        )
    if is_message(value):
        return say(
            "The field {field} is of type {type}, and is given {given}.",
            field=name,
            type=of,
            given=name_of(type(value)),
        )
    return say(
        "The field {field} is a message of its own: make it, {type}(), and fill its fields, or set"
        " them one by one: msg.{field}.{first} = …",
        field=name,
        type=kind,
        first=_first_field(message, name),
    )


def _first_field(message: Any, name: str) -> str:  # noqa: ANN401
    inner = getattr(message, f"_{name}", None)
    return next(iter(fields_of(inner)), "x") if is_message(inner) else "x"


def _list(name: str, what: str, parts: re.Match[str], value: Any) -> Words | None:  # noqa: ANN401
    """Say why a field that is a list does not take this value."""
    of = parts["of"] or parts["fixed"]
    if not _is_listlike(value) or (isinstance(value, dict)):
        return _no_list(name, what, of, value)
    kind = type(value).__module__.partition(".")[0]
    if kind == "numpy" and not parts["count"]:
        return say(
            "The field {field} takes a list, not an array of numpy: {what}.tolist().",
            field=name,
            what=what,
        )
    count = value.size if kind == "numpy" else len(value)
    if parts["count"] and count != int(parts["count"]):
        return say(
            "The field {field} has {count} values, always; this list has {given}.",
            field=name,
            count=int(parts["count"]),
            given=count,
        )
    if parts["most"] and count > int(parts["most"]):
        return say(
            "The field {field} has {count} values at most; this list has {given}.",
            field=name,
            count=int(parts["most"]),
            given=count,
        )
    if kind == "numpy" or isinstance(value, array.array):
        return say(
            "The values of {field} are of type {type}: {what}.tolist() makes a list of them that"
            " is converted.",
            field=name,
            type=of,
            what=what,
        )
    return _value_in_list(name, of, list(value))


def _no_list(name: str, what: str, of: str, value: Any) -> Words | None:  # noqa: ANN401
    if isinstance(value, str) and of in ("octet", "uint8"):
        if of == "octet":
            return say(
                "The field {field} is a list of single bytes: [bytes([b]) for b in"
                " {what}.encode()].",
                field=name,
                what=what,
            )
        return say(
            "The field {field} is a list of bytes, and {what} a text: list({what}.encode()).",
            field=name,
            what=what,
        )
    if is_from(value, "rclpy", "Parameter"):
        return parameter(what)
    if value is None:
        return is_none_here(what)
    return say("The field {field} is a list: write [{what}].", field=name, what=what)


def _value_in_list(name: str, of: str, values: list[Any]) -> Words | None:
    kind = of.rpartition("/")[2]
    bits = _BITS.fullmatch(of)
    for index, value in enumerate(values):
        if bits and isinstance(value, int):
            low, high = _range(bits)
            if not low <= value <= high:
                return say(
                    "The values of {field} are {low} to {high}; the one at [{index}] is {value}.",
                    field=name,
                    low=low,
                    high=high,
                    index=index,
                    value=value,
                )
        elif of in _FLOATS and not isinstance(value, float):
            return say(
                "The values of {field} are floats: write 1.0, not 1, or [float(v) for v in …].",
                field=name,
            )
        elif bits:
            return say("The values of {field} are whole numbers: [int(v) for v in …].", field=name)
        elif of in _TEXTS and not isinstance(value, str):
            return say("The values of {field} are texts: [str(v) for v in …].", field=name)
        elif of == "octet" and not isinstance(value, bytes):
            return say(
                "The field {field} is a list of single bytes: [bytes([b]) for b in data].",
                field=name,
            )
        elif of == "boolean" and not isinstance(value, bool):
            return say("The values of {field} are True or False.", field=name)
        elif "/" in of and not (is_message(value) and type(value).__name__ == kind):
            return say(
                "The values of {field} are messages {type}; the one at [{index}] is {given}.",
                field=name,
                type=of,
                index=index,
                given=name_of(type(value)),
            )
    return None


def _is_listlike(value: Any) -> bool:  # noqa: ANN401
    if type(value).__module__.partition(".")[0] == "numpy":
        return hasattr(value, "size") and getattr(value, "shape", ()) != ()
    return isinstance(value, (Sequence, AbstractSet, dict, array.array)) and not isinstance(
        value, str
    )


RULES = (field_value, not_made, sent, hollow)

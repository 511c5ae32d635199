"""Messages: values that a field does not take, and what is published."""

from __future__ import annotations

import ast
import inspect
import re
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
from launcher.faults.rules import field_lists
from launcher.faults.rules.conversions import constant_of, listing, single, takes
from launcher.faults.rules.field_lists import (
    BITS,
    FLOATS,
    LIST,
    TEXTS,
    FieldSlot,
    is_listlike,
    range_of,
    value_of_list,
)
from text.sentences import Words, say


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
    field = FieldSlot(type(message), name, of)
    parts = LIST.fullmatch(of)
    if parts is not None:
        return value_of_list(field, what, parts, value)
    if "/" in of:
        return _message(message, name, what, of, value)
    return _of_comma(field, what, value) or _one(field, what, value)


def _of_comma(field: FieldSlot, what: str, value: Any) -> Words | None:  # noqa: ANN401
    """Say that a comma at the end of a line has made a tuple."""
    if not isinstance(value, tuple) or len(value) != 1 or not field.takes(value[0]):
        return None
    return say(
        "{what} is one value in a tuple, as a comma at the end of a line makes it: take that comma away.", what=what
    )


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
            "This publisher was made for {wanted}, and is given {given}.", wanted=name, given=name_of(type(value))
        )
    if _suits(fields_of(kind).get("data", ""), value):
        data = FieldSlot(kind, "data", fields_of(kind)["data"])
        ways = (*single(what, value), *listing(what, value))
        made = what if data.takes(value) else data.first_fitting(iter(ways))
        return say(
            "publish takes a whole message: self.pub.publish({type}(data={what})).", type=name, what=made or "…"
        )
    return say("publish takes a whole message of type {type}, not {what}.", type=name, what=what)


def _suits(of: str, value: Any) -> bool:  # noqa: ANN401
    """Whether a field of this type may be what a value was meant for."""
    if of in FLOATS or BITS.fullmatch(of):
        return isinstance(value, (int, float))
    if of in TEXTS:
        return not is_listlike(value)
    return of == "boolean" or (LIST.fullmatch(of) is not None and isinstance(value, (list, tuple)))


def _asked(failure: Failure, value: Any, pair: Any, wanted: Any) -> Words | None:  # noqa: ANN401
    what, name = (_argument(failure, "call", "call_async", "send_goal", "send_goal_async"), name_of(wanted))
    part = f"{pair.__name__}.{name.rpartition('.')[2]}"
    if value is wanted:
        return no_brackets(what, part)
    return say("A call takes a request of type {type}: make one, {type}(), fill it, and hand it over.", type=part)


def no_brackets(what: str, kind: str) -> Words:
    """Say that a class was taken for an object of it."""
    return say(
        "{what} is the class {type} itself: with brackets, {type}(), a message is made of it.", what=what, type=kind
    )


def _argument(failure: Failure, *names: str) -> str:
    for call in failure.all(ast.Call):
        if isinstance(call.func, ast.Attribute) and call.func.attr in names and call.args:
            return shown(call.args[0])
    return "x"


def _given(failure: Failure, field: str) -> ast.AST | None:
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


def _one(field: FieldSlot, what: str, value: Any) -> Words | None:  # noqa: ANN401
    """Say why a field that holds one value does not take this one."""
    unsuitable = _unsuitable(field, what, value)
    if unsuitable is not None:
        return unsuitable
    if field.of in FLOATS:
        return _float(field, what, value)
    if field.of in TEXTS:
        return _text(field.name, what, value)
    if field.of == "boolean" and isinstance(value, str):
        return say("The field {field} is True or False, without quotes.", field=field.name)
    if field.of == "boolean":
        return say("The field {field} is True or False: bool({what}).", field=field.name, what=what)
    if field.of == "octet":
        return _byte(field, what, value)
    bits = BITS.fullmatch(field.of)
    return _whole(field, what, bits, value) if bits else None


def _byte(field: FieldSlot, what: str, value: Any) -> Words:  # noqa: ANN401
    if isinstance(value, int) and 0 <= value < 256:
        return say("The field {field} is a single byte: bytes([{what}]).", field=field.name, what=what)
    return field.is_given(what, value)


def _float(field: FieldSlot, what: str, value: Any) -> Words:  # noqa: ANN401
    if isinstance(value, float):
        return say(
            "The field {field} is a {type}, and {value:g} is too large for it.",
            field=field.name,
            type="float32" if field.of == "float" else "float64",
            value=value,
        )
    if isinstance(value, int) and re.fullmatch(r"-?\d+", what):
        return say("The field {field} is a float: write {value}.0, not {value}.", field=field.name, value=what)
    made = field.first_fitting(single(what, value))
    if made and not is_listlike(value):
        return say("The field {field} is a float: write {made}.", field=field.name, made=made)
    return _no_number(field, what, value)


def _no_number(field: FieldSlot, what: str, value: Any) -> Words:  # noqa: ANN401
    """Say that a value is many, or a text that is no number, or something else."""
    if isinstance(value, str):
        return say("The field {field} is a number, and {what} is a text that is none.", field=field.name, what=what)
    if is_listlike(value) and not isinstance(value, dict) and len(value):
        first = next(iter(value))
        if field.takes(first) and not isinstance(value, AbstractSet):
            return say(
                "The field {field} is one number, and {what} is many: choose one, {what}[0].",
                field=field.name,
                what=what,
            )
    return field.is_given(what, value)


def _text(name: str, what: str, value: Any) -> Words:  # noqa: ANN401
    if isinstance(value, (bytes, bytearray)):
        return say("The field {field} is a text, and {what} are bytes: {what}.decode().", field=name, what=what)
    return say("The field {field} is a text: write str({what}).", field=name, what=what)


def _whole(field: FieldSlot, what: str, bits: re.Match[str], value: Any) -> Words:  # noqa: ANN401
    low, high = range_of(bits)
    if isinstance(value, int) and not low <= value <= high:
        return say(
            "The field {field} holds {low} to {high}; {value} does not fit.",
            field=field.name,
            low=low,
            high=high,
            value=value,
        )
    constant = constant_of(field.kind, field.name, value)
    if constant:
        return say(
            "The field {field} is a whole number, which has a name: {constant}, without quotes.",
            field=field.name,
            constant=constant,
        )
    made = field.first_fitting(single(what, value))
    if made and isinstance(value, float):
        return say(
            "The field {field} is a whole number: int({what}) cuts the fraction off, round({what}) rounds.",
            field=field.name,
            what=what,
        )
    if made and not is_listlike(value):
        return say("The field {field} is a whole number: write {made}.", field=field.name, made=made)
    return _no_number(field, what, value)


def _unsuitable(field: FieldSlot, what: str, value: Any) -> Words | None:  # noqa: ANN401
    """Say what is wrong with a value that fits no field of a single value."""
    if value is None:
        return is_none_here(what)
    if is_from(value, "rclpy", "Parameter"):
        return parameter(what)
    if is_from(value, "rclpy", "Future", "Task"):
        return future(what)
    if is_message(value):
        return of_message(what, type(value))
    if isinstance(value, type):
        return say("{what} is a class, and the field {field} takes one value.", what=what, field=field.name)
    if inspect.isroutine(value):
        called = f"({what})" if what.startswith("lambda") else what
        return say("{what} is a function: the brackets are missing, {what}().", what=called)
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
            "The field {field} is a message of type {type}. The time now is self.get_clock().now().to_msg().",
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
        first=_first_field(message, name, value),
    )


def _first_field(message: Any, name: str, value: Any) -> str:  # noqa: ANN401
    """Return the field that takes the value itself, or else the first one."""
    inner = getattr(message, f"_{name}", None)
    fields = list(fields_of(inner)) if is_message(inner) else []
    fits = (each for each in fields if takes(type(inner), each, value))
    return next(fits, next(iter(fields), "x"))


RULES = (field_value, not_made, sent, field_lists.hollow)

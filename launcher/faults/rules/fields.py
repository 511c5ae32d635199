"""Messages: values that a field does not take, fields that there are none, and what is sent instead of one.

What makes a value fit is tried on a message of the same class before it is suggested.
"""

from __future__ import annotations

import array
import ast
import inspect
import math
import re
from collections.abc import Callable, Iterator, Sequence
from collections.abc import Set as AbstractSet
from typing import Any

from launcher.faults.failure import (
    UNKNOWN,
    Failure,
    fields_of,
    is_from,
    is_message,
    is_message_class,
    is_service_class,
    name_of,
    shown,
)
from launcher.faults.remedy import future, given, is_none_here, listed, of_message, parameter
from text.i18n import N_
from text.sentences import Words, say
from text.suggestions import nearest

_LIST = re.compile(r"sequence<(?P<of>.+?)(?:, \d+)?>|(?P<fixed>.+)\[(?P<count>\d+)\]")
_FLOATS = ("double", "float")
_TEXTS = ("string", "wstring")
_BITS = re.compile(r"(u?)int(\d+)")
_MOST = 1 << 20
"""Values of a list that are converted for a trial."""
Ways = Iterator[tuple[str, Callable[[], Any]]]
"""Expressions, and what gives their values."""


def _takes(kind: Any, field: str, value: Any) -> bool:
    """Whether a field of a message takes a value, as its own setter says."""
    message = kind()
    message._check_fields = True
    try:
        setattr(message, field, value)
    except Exception:  # noqa: BLE001 - an array of numpy raises what it likes when it is asked
        return False
    return True


def _fitting(kind: Any, field: str, ways: Ways) -> str:
    """Return the first expression whose value the field takes, empty if there is none."""
    for expression, value in ways:
        try:
            made = value()
        except Exception:  # noqa: BLE001 - what cannot be converted this way
            continue
        if _takes(kind, field, made):
            return expression
    return ""


def _single(what: str, value: Any) -> Ways:
    if re.fullmatch(r"-?\d+", what):
        yield f"{what}.0", lambda: float(value)
    yield f"float({what})", lambda: float(value)
    yield f"int({what})", lambda: int(value)
    if isinstance(value, str):
        yield f"int(float({what}))", lambda: int(float(value))


def _listing(what: str, value: Any, count: int = 1) -> Ways:
    times = f" * {count}" if count > 1 else ""
    yield f"[{what}]{times}", lambda: [value] * count
    for expression, made in _single(what, value):
        yield f"[{expression}]{times}", lambda made=made: [made()] * count  # type: ignore[misc]


def _of_array(what: str, value: Any, of: str) -> Ways:
    """Yield what makes a flat list, or bytes, of an array of numpy; `of`: the field's type."""
    value = value[:1] if value.size > _MOST else value
    if of == "uint8" and str(value.dtype) == "uint8":
        yield f"{what}.tobytes()", value.tobytes
    flat = "" if value.ndim == 1 else ".flatten()"
    yield f"{what}{flat}.tolist()", lambda: value.flatten().tolist()
    for kind in (float, int, str):
        yield (
            f"{what}{flat}.astype({kind.__name__}).tolist()",
            lambda kind=kind: value.flatten().astype(kind).tolist(),  # type: ignore[misc]
        )


def _each_of(values: list[Any]) -> Ways:
    yield "[float(v) for v in …]", lambda: [float(each) for each in values]
    yield "[int(v) for v in …]", lambda: [int(each) for each in values]
    yield "[v for row in … for v in row]", lambda: [each for row in values for each in row]
    yield "[float(v) for row in … for v in row]", lambda: [float(each) for row in values for each in row]


def field_value(failure: Failure) -> Words | None:
    """A field was given a value that it does not take; the setter of the message knows both."""
    inner = failure.inner
    if not isinstance(failure.error, AssertionError) or inner is None:
        return None
    message, name = inner.values.get("self"), inner.function
    if "value" not in inner.values or not is_message(message) or name not in fields_of(message):
        return None
    value, of = inner.values["value"], fields_of(message)[name]
    what = shown(_given(failure, name)) or "x"
    parts = _LIST.fullmatch(of)
    if parts is not None:
        return _many(type(message), name, what, parts, value)
    if "/" in of:
        return _message(message, name, what, of, value)
    return _one(type(message), name, what, of, value)


def _given(failure: Failure, field: str) -> ast.AST | None:
    """Return the learner's expression for the value of a field."""
    made = len(failure.levels) > 1 and failure.levels[-2].function == "__init__"
    for call in failure.all(ast.Call) if made else ():
        for keyword in call.keywords:
            if keyword.arg == field:
                return keyword.value
    statement = failure.statement
    return statement.value if isinstance(statement, (ast.Assign, ast.AugAssign, ast.AnnAssign)) else None


def _unsuitable(name: str, what: str, value: Any) -> Words | None:
    """Say what is wrong with a value that fits no field."""
    if value is None:
        return is_none_here(what)
    if is_from(value, "rclpy", "Parameter"):
        return parameter(what)
    if is_from(value, "rclpy", "Future", "Task"):
        return future(what)
    if isinstance(value, type):
        return say("{what} is a class, and the field {field} takes one value.", what=what, field=name)
    if inspect.isroutine(value):
        called = f"({what})" if what.startswith("lambda") else what
        return say("{what} is a function: the brackets are missing, {what}().", what=called)
    return None


def _is_given(name: str, of: str, what: str, value: Any) -> Words:
    phrase = N_("The field {field} is of type {type}, and {what} is of type {given}.")
    return say(phrase, field=name, type=of, what=what, given=name_of(type(value)))


def _one(kind: Any, name: str, what: str, of: str, value: Any) -> Words | None:
    """Say why a field that holds one value does not take this one."""
    words = of_message(what, type(value)) if is_message(value) else _unsuitable(name, what, value)
    if words is not None:
        return words
    if isinstance(value, tuple) and len(value) == 1 and _takes(kind, name, value[0]):
        phrase = N_("{what} is one value in a tuple, as a comma at the end of a line makes it: take that comma away.")
        return say(phrase, what=what)
    if isinstance(value, (bytes, bytearray)) and of in _TEXTS:
        return say("The field {field} is a text, and {what} are bytes: {what}.decode().", field=name, what=what)
    if of in _TEXTS:
        return say("The field {field} is a text: write str({what}).", field=name, what=what)
    if of == "boolean" and isinstance(value, str):
        return say("The field {field} is True or False, without quotes.", field=name)
    if of == "boolean":
        return say("The field {field} is True or False: bool({what}).", field=name, what=what)
    return _number(kind, name, what, of, value)


def _number(kind: Any, name: str, what: str, of: str, value: Any) -> Words:
    bits = _BITS.fullmatch(of)
    if bits and isinstance(value, int):
        low, high = _range_of(bits)
        phrase = N_("The field {field} holds {low} to {high}; {value} does not fit.")
        return say(phrase, field=name, low=low, high=high, value=value)
    if of in _FLOATS and isinstance(value, int) and re.fullmatch(r"-?\d+", what):
        return say("The field {field} is a float: write {value}.0, not {value}.", field=name, value=what)
    if of in _FLOATS and isinstance(value, float):
        phrase = N_("The field {field} is a {type}, and {value:g} is too large for it.")
        return say(phrase, field=name, type="float32" if of == "float" else "float64", value=value)
    constant = _constant_of(kind, name, value) if bits else ""
    if constant:
        phrase = N_("The field {field} is a whole number, which has a name: {constant}, without quotes.")
        return say(phrase, field=name, constant=constant)
    if bits and isinstance(value, float) and math.isfinite(value):
        phrase = N_("The field {field} is a whole number: int({what}) cuts the fraction off, round({what}) rounds.")
        return say(phrase, field=name, what=what)
    made = "" if _is_listlike(value) else _fitting(kind, name, _single(what, value))
    if made and of in _FLOATS:
        return say("The field {field} is a float: write {made}.", field=name, made=made)
    if made:
        return say("The field {field} is a whole number: write {made}.", field=name, made=made)
    if isinstance(value, str):
        return say("The field {field} is a number, and {what} is a text that is none.", field=name, what=what)
    if isinstance(value, (list, tuple)) and value and _takes(kind, name, value[0]):
        return say(
            "The field {field} is one number, and {what} is many: choose one, {what}[0].", field=name, what=what
        )
    return _is_given(name, of, what, value)


def _constant_of(kind: Any, field: str, value: Any) -> str:
    """Return the constant of a message that a text names: `Range.ULTRASOUND`."""
    name = value.strip().upper().replace(" ", "_") if isinstance(value, str) else ""
    fits = [
        each
        for each in dir(type(kind))
        if name and each.isupper() and each[0] != "_" and (each == name or each.endswith(f"_{name}"))
        if _takes(kind, field, getattr(kind, each))
    ]
    return f"{kind.__name__}.{fits[0]}" if len(fits) == 1 else ""


def _message(message: Any, name: str, what: str, of: str, value: Any) -> Words:
    """Say why a field that is a message does not take this value."""
    kind = of.rpartition("/")[2]
    if is_message_class(value) and value.__name__ == kind:
        return _no_brackets(what, kind)
    if is_from(value, "rclpy", "Time", "Duration"):
        phrase = N_(
            "The field {field} is a message, and {what} is of type {type} of rclpy: {what}.to_msg()"
            " makes the message."
        )
        return say(phrase, field=name, type=kind, what=what)
    if of == "builtin_interfaces/Time":
        phrase = N_("The field {field} is a message of type {type}. The time now is self.get_clock().now().to_msg().")
        return say(phrase, field=name, type=kind)
    if is_message(value):
        phrase = N_("The field {field} is of type {type}, and is given {given}.")
        return say(phrase, field=name, type=of, given=name_of(type(value)))
    inner = getattr(message, f"_{name}", None)
    fields = list(fields_of(inner)) if is_message(inner) else ["x"]
    return say(
        "The field {field} is a message of its own: make it, {type}(), and fill its fields, or set"
        " them one by one: msg.{field}.{first} = …",
        field=name,
        type=kind,
        first=next((each for each in fields if _takes(type(inner), each, value)), fields[0]),
    )


def _many(kind: Any, name: str, what: str, parts: re.Match[str], value: Any) -> Words | None:
    """Say why a field that is a list does not take this value."""
    of, count = parts["of"] or parts["fixed"], parts["count"]
    if not _is_listlike(value) or isinstance(value, dict):
        made = _fitting(kind, name, _listing(what, value, int(count or 1)))
        return _unsuitable(name, what, value) or (
            say("The field {field} is a list: write {made}.", field=name, made=made)
            if made
            else _is_given(name, parts[0], what, value)
        )
    is_array = _is_of_numpy(value)
    length = value.size if is_array else len(value)
    if count and length != int(count):
        phrase = N_("The field {field} has {count} values, always; this list has {given}.")
        return say(phrase, field=name, count=int(count), given=length)
    if not is_array:
        return _within(kind, name, of, list(value))
    made = _fitting(kind, name, _of_array(what, value, of))
    if not made:
        return _is_given(name, parts[0], what, value)
    return say("The field {field} takes a list, not an array of numpy: {made}.", field=name, made=made)


def _within(kind: Any, name: str, of: str, values: list[Any]) -> Words | None:
    """Say which value does not go into a list; None if all do."""
    bits = _BITS.fullmatch(of)
    for index, value in enumerate(values):
        at: dict[str, Any] = {"field": name, "index": index}
        if bits and isinstance(value, int):
            low, high = _range_of(bits)
            if not low <= value <= high:
                phrase = N_("The values of {field} are {low} to {high}; the one at [{index}] is {value}.")
                return say(phrase, **at, low=low, high=high, value=value)
        elif "/" in of and not (is_message(value) and type(value).__name__ == of.rpartition("/")[2]):
            phrase = N_("The values of {field} are messages {type}; the one at [{index}] is {given}.")
            return say(phrase, **at, type=of, given=given(value))
        elif bits or (of in _FLOATS and not isinstance(value, float)):
            return _numbers(kind, name, of, values, index)
        elif of in _TEXTS and not isinstance(value, str):
            return say("The values of {field} are texts: [str(v) for v in …].", field=name)
    return None


def _numbers(kind: Any, name: str, of: str, values: list[Any], index: int) -> Words:
    made = _fitting(kind, name, _each_of(values))
    if "row" in made:
        return say("The field {field} is one flat list: {made}.", field=name, made=made)
    if made and of in _FLOATS:
        return say("The values of {field} are floats: write 1.0, not 1, or [float(v) for v in …].", field=name)
    if made:
        return say("The values of {field} are whole numbers: [int(v) for v in …].", field=name)
    phrase = N_("The values of {field} are of type {type}; the one at [{index}] is {value}.")
    return say(phrase, field=name, type=of, index=index, value=repr(values[index]))


def _range_of(bits: re.Match[str]) -> tuple[int, int]:
    size = int(bits[2])
    return (0, 2**size - 1) if bits[1] else (-(2 ** (size - 1)), 2 ** (size - 1) - 1)


def _is_of_numpy(value: object) -> bool:
    return type(value).__module__.partition(".")[0] == "numpy"


def _is_listlike(value: Any) -> bool:
    """Whether it holds several values, and is not a text."""
    if _is_of_numpy(value):
        return hasattr(value, "size") and getattr(value, "shape", ()) != ()
    return isinstance(value, (Sequence, AbstractSet, dict, array.array)) and not isinstance(value, str)


def hollow(failure: Failure) -> Words | None:
    """A list of messages that is published has one of another type in it."""
    inner = failure.inner
    is_published = inner is not None and inner.function == "publish" and inner.is_in("rclpy", "publisher")
    message = inner.values.get("msg") if inner is not None and is_published else None
    for name, of in fields_of(message).items() if is_message(message) else ():
        value, parts = getattr(message, name), _LIST.fullmatch(of)
        if parts is not None and isinstance(value, list):
            words = _within(type(message), name, parts["of"] or parts["fixed"], value)
            if words is not None:
                return words
    return None


def unknown_field(failure: Failure) -> Words | None:
    """The constructor of a message was given a field that it has not."""
    inner = failure.inner
    if not isinstance(failure.error, AssertionError) or inner is None:
        return None
    message, fields = inner.values.get("self"), inner.values.get("kwargs")
    if inner.function != "__init__" or not is_message(message) or not isinstance(fields, dict):
        return None
    name = next((each for each in fields if each not in fields_of(message)), "")
    return no_field(type(message), name) if name else None


def no_field(kind: Any, name: str) -> Words:
    """Say that a class of messages has no such field, and which it has."""
    fields = list(fields_of(kind))
    if kind.__name__ == "Header" and name == "seq":
        return say("seq is of ROS 1: a header of ROS 2 has stamp and frame_id.")
    if kind.__module__.startswith("builtin_interfaces.") and name == "now":
        return time_now()
    if kind.__module__.startswith("builtin_interfaces.") and name in ("to_sec", "to_nsec", "seconds", "nanoseconds"):
        phrase = N_(
            "The {type} of a message has sec and nanosec. As one number:"
            " {type}.from_msg(stamp).nanoseconds / 1e9, from rclpy.{module} import {type}."
        )
        return say(phrase, type=kind.__name__, module=kind.__name__.lower())
    ways = list(_ways(kind))
    said = {"type": name_of(kind), "field": name}
    joined = next((way for way in ways if "." in way and _plain(way) == _plain(name)), "")
    if joined:
        return say("{type} has no field {field}; did you mean {meant}?", **said, meant=joined)
    paths = [way for way in ways if way.endswith(f".{name}")]
    if paths:
        return say("{type} has no field {field} itself; what has it is in it: {paths}.", **said, paths=listed(paths))
    meant = nearest(name, fields)
    if meant:
        return say("{type} has no field {field}; did you mean {meant}?", **said, meant=meant)
    return say("{type} has no field {field}. It has: {fields}.", **said, fields=listed(fields) or "-")


def _ways(kind: Any, depth: int = 3) -> Iterator[str]:
    """Yield the ways to all fields within the fields of a message: `pose.position.x`."""
    made = kind()
    for field in fields_of(kind):
        yield field
        inner = getattr(made, field, None)
        if depth and is_message(inner):
            yield from (f"{field}.{way}" for way in _ways(type(inner), depth - 1))


def _plain(name: str) -> str:
    return name.replace("_", "").replace(".", "").lower()


def time_now() -> Words:
    return say(
        "The time of this moment is self.get_clock().now(), and for a message self.get_clock().now().to_msg()."
    )


def positional_field(failure: Failure) -> Words | None:
    """A message was made with a value that has no name."""
    if not isinstance(failure.error, TypeError) or not failure.is_own:
        return None
    for call in failure.all(ast.Call):
        kind = failure.value(call.func)
        if not is_message_class(kind) or not call.args:
            continue
        fields, what = list(fields_of(kind)), shown(call.func)
        names = ["data"] if "data" in fields and len(call.args) == 1 else fields
        pairs = list(zip(names, call.args, strict=False))
        made = [_expression(failure, kind, name, each) for name, each in pairs]
        if all(made) and len(call.args) <= len(fields):
            return say(
                "The fields of a message are given by name: {type}({arguments}).",
                type=what,
                arguments=", ".join(f"{name}={each}" for (name, _), each in zip(pairs, made, strict=True)),
            )
        phrase = N_("The fields of a message are given by name, {type}(name=…). It has: {fields}.")
        return say(phrase, type=what, fields=listed(fields) or "-")
    return None


def _expression(failure: Failure, kind: Any, field: str, node: ast.expr) -> str:
    """Return what to write for a value of a field, empty if it cannot be told."""
    what, value = shown(node), failure.value(node)
    if value is UNKNOWN:
        inner = fields_of(kind)[field]
        return "" if "/" in inner or "[" in inner or "<" in inner else what
    if _takes(kind, field, value):
        return what
    return _fitting(kind, field, _single(what, value)) or _fitting(kind, field, _listing(what, value))


def not_made(failure: Failure) -> Words | None:
    """A service or an action is not made; its request or goal is."""
    for call in failure.all(ast.Call) if isinstance(failure.error, NotImplementedError) else ():
        kind = failure.value(call.func)
        inner = "Request" if is_service_class(kind) else "Goal" if hasattr(kind, "Goal") else ""
        if inner:
            phrase = N_(
                "{type} is only the pair of what is asked and answered; make"
                " {type}.{inner}(), or the other part of it."
            )
            return say(phrase, type=shown(call.func), inner=inner)
    return None


def sent(failure: Failure) -> Words | None:
    """`publish`, `call_async` and `send_goal_async` were given something of another type."""
    inner = failure.inner
    if not isinstance(failure.error, TypeError) or inner is None or not inner.is_in("rclpy"):
        return None
    values, function = inner.values, inner.function
    if function == "publish" and inner.is_in("rclpy", "publisher"):
        return _published(_argument(failure, function), values["msg"], values["self"].msg_type)
    if function in ("call", "call_async") and "request" in values and inner.is_in("rclpy", "client"):
        pair, wanted, value = values["self"].srv_type, values["self"].srv_type.Request, values["request"]
    elif function in ("send_goal", "send_goal_async") and "goal" in values:
        pair, wanted, value = values["self"]._action_type, values["self"]._action_type.Goal, values["goal"]
    else:
        return None
    part = f"{pair.__name__}.{name_of(wanted).rpartition('.')[2]}"
    if value is wanted:
        return _no_brackets(_argument(failure, function), part)
    return say("A call takes a request of type {type}: make one, {type}(), fill it, and hand it over.", type=part)


def _published(what: str, value: Any, kind: Any) -> Words:
    name, of = name_of(kind), fields_of(kind).get("data", "")
    if value is kind:
        return _no_brackets(what, name)
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
    made = what if _takes(kind, "data", value) else _fitting(kind, "data", _single(what, value)) if of else ""
    if of and not isinstance(value, type):
        return say(
            "publish takes a whole message: self.pub.publish({type}(data={what})).", type=name, what=made or "…"
        )
    return say("publish takes a whole message of type {type}, not {what}.", type=name, what=what)


def _no_brackets(what: str, kind: str) -> Words:
    return say(
        "{what} is the class {type} itself: with brackets, {type}(), a message is made of it.", what=what, type=kind
    )


def _argument(failure: Failure, name: str) -> str:
    calls = (each for each in failure.all(ast.Call) if getattr(each.func, "attr", "") == name and each.args)
    return next((shown(each.args[0]) for each in calls), "x")


def result(failure: Failure) -> Words | None:
    """The callback of an action's server has not returned its result."""
    level = failure.inner
    if level is None or not isinstance(failure.error, AssertionError) or level.function != "result":
        return None
    kind, value = type(level.values.get("self")).__name__, level.values.get("value")
    if not kind.endswith("_GetResult_Response"):
        return None
    action = kind.removesuffix("_GetResult_Response")
    if value is None:
        return say(
            "The action's callback has to return the result in every case: return {action}.Result().", action=action
        )
    phrase = N_("The action's callback has to return {action}.Result(), filled, and returns {given}.")
    return say(phrase, action=action, given=given(value))


def feedback(failure: Failure) -> Words | None:
    """`publish_feedback` was given something else than feedback."""
    level = next((each for each in failure.below("rclpy") if each.function == "publish_feedback"), None)
    if level is None or not isinstance(failure.error, (TypeError, AssertionError)):
        return None
    value, action = level.values.get("feedback"), level.values["self"]._action_server.action_type
    if isinstance(value, action.Feedback):
        return None
    phrase = N_("publish_feedback takes {action}.Feedback(), filled, and is given {given}.")
    return say(phrase, action=action.__name__, given=given(value))

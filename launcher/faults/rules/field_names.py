"""Messages: fields that there are none, or that were given without their names."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any

from launcher.faults.failure import UNKNOWN, Failure, fields_of, is_message, is_message_class, name_of, shown
from launcher.faults.remedy import listed
from launcher.faults.rules.conversions import first_fitting, listing, single, takes
from text.sentences import Words, say
from text.suggestions import nearest


def unknown_field(failure: Failure) -> Words | None:
    """The constructor of a message was given a field that it has not."""
    inner = failure.inner
    if not isinstance(failure.error, AssertionError) or inner is None:
        return None
    message, given = inner.values.get("self"), inner.values.get("kwargs")
    if inner.function != "__init__" or not is_message(message) or not isinstance(given, dict):
        return None
    (name, *_) = [name for name in given if name not in fields_of(message)] or [""]
    return no_field(type(message), name) if name else None


def no_field(kind: Any, name: str) -> Words:  # noqa: ANN401 - a class of messages
    """Say that a message has no such field, and which it has."""
    fields = list(fields_of(kind))
    special = _of_header(kind, name)
    if special is not None:
        return special
    way = next((way for way in _leaves(kind) if _is_run_together(name, way)), "")
    if way:
        return say("{type} has no field {field}; did you mean {meant}?", type=name_of(kind), field=name, meant=way)
    paths = list(_inside(kind, name))
    if paths:
        return say(
            "{type} has no field {field} itself; what has it is in it: {paths}.",
            type=name_of(kind),
            field=name,
            paths=listed(paths),
        )
    meant = nearest(name, fields)
    if meant:
        return say("{type} has no field {field}; did you mean {meant}?", type=name_of(kind), field=name, meant=meant)
    if not fields:
        return say("{type} has no fields at all.", type=name_of(kind))
    return say(
        "{type} has no field {field}. It has: {fields}.", type=name_of(kind), field=name, fields=listed(fields)
    )


def _inside(kind: Any, name: str, depth: int = 3) -> Iterator[str]:  # noqa: ANN401
    """Yield the ways to a field of this name within the fields of a message: `pose.position`."""
    made = kind()
    for field in fields_of(kind):
        inner = getattr(made, field, None)
        if is_message(inner):
            if name in fields_of(inner):
                yield f"{field}.{name}"
            elif depth > 1:
                yield from (f"{field}.{way}" for way in _inside(type(inner), name, depth - 1))


def _leaves(kind: Any, depth: int = 3) -> Iterator[str]:  # noqa: ANN401
    """Yield the ways to the fields of a message that are no messages themselves."""
    made = kind()
    for field in fields_of(kind):
        inner = getattr(made, field, None)
        if not is_message(inner):
            yield field
        elif depth:
            yield from (f"{field}.{way}" for way in _leaves(type(inner), depth - 1))


def _is_run_together(name: str, way: str) -> bool:
    """Whether a name is a way without its points: `linear_x` for `linear.x`."""
    return "." in way and name.replace("_", "").lower() == way.replace(".", "").replace("_", "")


def _of_header(kind: Any, name: str) -> Words | None:  # noqa: ANN401
    """Say what has taken the place of what ROS 1 has in headers and times."""
    if kind.__name__ == "Header" and name == "seq":
        return say("seq is of ROS 1: a header of ROS 2 has stamp and frame_id.")
    if not kind.__module__.startswith("builtin_interfaces."):
        return None
    if name == "now":
        return time_now()
    if name in ("to_sec", "to_nsec", "seconds", "nanoseconds"):
        return say(
            "The {type} of a message has sec and nanosec. As one number:"
            " {type}.from_msg(stamp).nanoseconds / 1e9, from rclpy.{module} import {type}.",
            type=kind.__name__,
            module=kind.__name__.lower(),
        )
    meant = {"secs": "sec", "nsec": "nanosec", "nsecs": "nanosec", "nanosecs": "nanosec"}.get(name)
    if meant is None:
        return None
    return say("{type} has no field {field}; did you mean {meant}?", type=kind.__name__, field=name, meant=meant)


def time_now() -> Words:
    """Say how the time of this moment is had."""
    return say(
        "The time of this moment is self.get_clock().now(), and for a message self.get_clock().now().to_msg()."
    )


def positional_field(failure: Failure) -> Words | None:
    """A message was made with a value that has no name."""
    if not isinstance(failure.error, TypeError) or not failure.is_own:
        return None
    for call in failure.all(ast.Call):
        kind = failure.value(call.func)
        if is_message_class(kind) and call.args:
            return _named(failure, call, kind)
    return None


def _named(failure: Failure, call: ast.Call, kind: Any) -> Words:  # noqa: ANN401
    """Say how a message is made of these values, or of which fields it consists."""
    fields = fields_of(kind)
    if len(call.args) <= len(fields):
        names = ["data"] if "data" in fields and len(call.args) == 1 else list(fields)
        pairs = list(zip(names, call.args, strict=False))
        made = [_expression(failure, kind, name, each) for name, each in pairs]
        if all(made):
            return say(
                "The fields of a message are given by name: {type}({arguments}).",
                type=shown(call.func),
                arguments=", ".join(f"{name}={each}" for (name, _), each in zip(pairs, made, strict=True)),
            )
    way = next(_leaves(kind), "")
    if "." in way and "data" not in fields:
        return say(
            "The fields of a message are given by name, and {field} is a message of its own:"
            " msg = {type}(), and then msg.{way} = ….",
            field=way.partition(".")[0],
            type=shown(call.func),
            way=way,
        )
    return say(
        "The fields of a message are given by name, {type}(name=…). It has: {fields}.",
        type=shown(call.func),
        fields=listed(list(fields)) or "-",
    )


def _expression(failure: Failure, kind: Any, field: str, node: ast.expr) -> str:  # noqa: ANN401
    """Return what to write for a value of a field, empty if it cannot be told."""
    what, value = shown(node), failure.value(node)
    if value is UNKNOWN:
        of = failure.type_of(node)
        inner = fields_of(kind)[field]
        if is_message_class(of):
            return what if inner.rpartition("/")[2] == name_of(of) else ""
        return "" if "/" in inner or "[" in inner or "<" in inner else what
    if takes(kind, field, value):
        return what
    return first_fitting(kind, field, single(what, value)) or first_fitting(kind, field, listing(what, value))


RULES = (unknown_field, positional_field)

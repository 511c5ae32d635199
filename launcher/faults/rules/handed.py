"""What a function of ROS was handed, against what it asks for by its own annotations and rules."""

from __future__ import annotations

import ast
import inspect
import typing
from typing import TYPE_CHECKING

from launcher.faults.failure import (
    UNKNOWN,
    Failure,
    TraceLevel,
    is_from,
    is_message,
    name_of,
    shown,
)
from launcher.faults.remedy import listed
from text.sentences import say

if TYPE_CHECKING:
    from text.sentences import Words

_SETTERS = ("set_parameters", "set_parameters_atomically", "_check_undeclared_parameters")
_LIBRARIES = ("rclpy", "tf2_ros", "cv_bridge")


def called(failure: Failure) -> tuple[ast.Call, TraceLevel] | None:
    """Return the call of the learner's own line whose function failed inside, and its level."""
    if failure.own is None or failure.is_own:
        return None
    level = failure.levels[failure.levels.index(failure.own) + 1]
    if not any(f"/{library}/" in level.file for library in _LIBRARIES):
        return None
    for call in failure.all(ast.Call):
        name = call.func.attr if isinstance(call.func, ast.Attribute) else shown(call.func)
        if level.function in (name, "__init__"):
            return call, level
    return None


def on_class(failure: Failure) -> Words | None:
    """A method was called on the class, which was kept without its brackets."""
    found = called(failure)
    if found is None or not isinstance(found[0].func, ast.Attribute):
        return None
    func, level = found[0].func, found[1]
    kind = failure.value(func.value)
    if not isinstance(kind, type) or "self" not in level.values:
        return None
    if isinstance(level.values["self"], kind):
        return None
    return say(
        "{what} is the class {name} itself: its brackets are missing where it is made, {name}().",
        what=shown(func.value),
        name=kind.__name__,
    )


def annotated(failure: Failure) -> Words | None:
    """An argument is of another class than the function says that it takes."""
    found = called(failure)
    if found is None or not isinstance(failure.error, (TypeError, AttributeError, ValueError)):
        return None
    call, level = found
    function = failure.called(call)
    function = inspect.unwrap(function) if callable(function) else function
    try:
        hints, parameters = typing.get_type_hints(function), inspect.signature(function).parameters
    except Exception:  # noqa: BLE001 - a hint may be anything, and of what is only checked
        return _unlike_duration(function, level)
    for name, kind in hints.items():
        value = level.values.get(name, UNKNOWN)
        if value is UNKNOWN or name not in parameters or not isinstance(kind, type):
            continue
        # A default may be of another class than what is asked for, and a float may be an int.
        if value is parameters[name].default or kind is float or isinstance(value, kind):
            continue
        return _other(level.function, name, kind, value)
    return None


def _unlike_duration(function: object, level: TraceLevel) -> Words | None:
    for name, kind in getattr(function, "__annotations__", {}).items():
        value = level.values.get(name)
        if str(kind).endswith("Duration") and isinstance(value, (int, float)):
            return _duration(level.function, name, value)
    return None


def _duration(function: str, name: str, value: float) -> Words:
    return say(
        "{function}: {name} is a Duration of rclpy: Duration(seconds={value}), from"
        " rclpy.duration import Duration.",
        function=function,
        name=name,
        value=str(value),
    )


def _other(function: str, name: str, kind: type, value: object) -> Words:
    if kind.__name__ == "Duration" and isinstance(value, (int, float)):
        return _duration(function, name, value)
    return say(
        "{function}: {name} is of type {type}, and is given {given}.",
        function=function,
        name=name,
        type=kind.__name__,
        given=name_of(value if isinstance(value, type) else type(value)),
    )


def parameters(failure: Failure) -> Words | None:
    """Parameters were set by something that is no list of them."""
    level = next((each for each in failure.below("rclpy") if each.function in _SETTERS), None)
    if level is None or not isinstance(failure.error, (TypeError, AttributeError)):
        return None
    given = level.values.get("parameter_list")
    if is_from(given, "rclpy", "Parameter"):
        return say("{call} takes a list, even of one parameter: [parameter].", call=level.function)
    if isinstance(given, (list, tuple)) and not all(
        is_from(each, "rclpy", "Parameter") for each in given
    ):
        return say(
            "{call} takes a list of parameters: [Parameter('speed', value=2.0)], from"
            " rclpy.parameter import Parameter.",
            call=level.function,
        )
    return None


def parameter_value(failure: Failure) -> Words | None:
    """A parameter cannot hold such a value, or not as this type."""
    inner = failure.inner
    if inner is None or not inner.is_in("rclpy", "parameter"):
        return None
    if isinstance(failure.error, TypeError) and inner.function == "from_parameter_value":
        value = inner.values.get("parameter_value")
        if isinstance(value, (list, tuple)):
            return say(
                "The values of a parameter's list are all of one type, and these are: {types}.",
                types=listed(sorted({name_of(type(each)) for each in value})),
            )
        return say(
            "A parameter is a number, a text, True or False, or a list of one of them, and not"
            " {type}.",
            type=name_of(value if isinstance(value, type) else type(value)),
        )
    if isinstance(failure.error, ValueError) and inner.function == "__init__":
        return say(
            "The type of the parameter, {type}, and its value, {value}, do not agree:"
            " Parameter({name!r}, value=…) finds the type by itself.",
            type=str(getattr(inner.values.get("type_"), "name", "?")),
            value=str(inner.values.get("value")),
            name=str(inner.values.get("name")),
        )
    return None


def policy(failure: Failure) -> Words | None:
    """A policy of a QoS was given as a text."""
    inner = failure.inner
    if inner is None or not isinstance(failure.error, AssertionError):
        return None
    if not inner.is_in("rclpy", "qos") or not isinstance(inner.values.get("value"), str):
        return None
    kind = f"{inner.function.title()}Policy"
    return say(
        "The policies of a QoS are no texts: {kind}.{name}, from rclpy.qos import {kind}.",
        kind=kind,
        name=str(inner.values["value"]).upper(),
    )


def executor(failure: Failure) -> Words | None:
    """An executor was given the class of a node, or a node where it is made."""
    for level in failure.below("rclpy"):
        me = level.values.get("self")
        if not level.is_in("rclpy", "executors"):
            continue
        if is_from(level.values.get("num_threads"), "rclpy", "Node"):
            return say("An executor is made without a node: executor.add_node(node) follows.")
        nodes = getattr(me, "_nodes", ())
        cls = next((each for each in nodes if isinstance(each, type)), None)
        if cls is not None:
            return say(
                "The executor was given the class {name}: make a node of it first,"
                " executor.add_node({name}()).",
                name=cls.__name__,
            )
    return None


def transform(failure: Failure) -> Words | None:
    """`sendTransform` was given something else than a transform with its frames."""
    found = called(failure)
    if found is None or found[1].function != "sendTransform":
        return None
    value = found[1].values.get("transform")
    return say(
        "sendTransform takes a TransformStamped, or a list of them, and is given {given}.",
        given=name_of(value if isinstance(value, type) else type(value)),
    )


def picture(failure: Failure) -> Words | None:
    """cv_bridge was given something else than a picture, or than the message of one."""
    found = called(failure)
    if found is None or not found[1].is_in("cv_bridge", "bridge"):
        return None
    call, level = found
    values = level.values
    if "img_msg" in values and not is_message(values["img_msg"]):
        return say(
            "{call} takes the message of a picture, as a callback gets it, and is given {given}.",
            call=shown(call.func),
            given=name_of(type(values["img_msg"]))
            if not isinstance(values["img_msg"], type)
            else say("the class {name}", name=values["img_msg"].__name__),
        )
    if "cvim" in values and type(values["cvim"]).__module__ != "numpy":
        return say(
            "{call} takes an array of numpy, height × width × channels of uint8, and is given"
            " {given}.",
            call=shown(call.func),
            given=name_of(type(values["cvim"])),
        )
    return None


def substitution(failure: Failure) -> Words | None:
    """Curly brackets stand in the name of a topic that is no f-string."""
    level = next((each for each in failure.below("rclpy") if "create_" in each.function), None)
    if level is None or not isinstance(failure.error, ValueError):
        return None
    name = level.values.get("topic", level.values.get("srv_name"))
    if not isinstance(name, str) or "{" not in name:
        return None
    return say(
        'The f is missing in front of the name: f"{name}" puts the value of a variable there.',
        name=name,
    )


RULES = (
    on_class, parameters, parameter_value, policy, executor, transform, picture,
    substitution, annotated,
)  # fmt: skip

"""What a function of ROS was handed, against what it asks for by its own annotations and rules."""

from __future__ import annotations

import ast
import inspect
import re
import typing
from typing import TYPE_CHECKING

from launcher.faults.failure import UNKNOWN, Failure, TraceLevel, is_from, is_message, name_of, shown
from launcher.faults.remedy import listed, of_text
from launcher.faults.rules.callbacks import not_handed_over
from text.sentences import say
from text.suggestions import nearest

if TYPE_CHECKING:
    from text.sentences import Words

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
        "{function}: {name} is a Duration of rclpy: Duration(seconds={value}), from rclpy.duration import Duration.",
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


def policy(failure: Failure) -> Words | None:
    """A policy of a QoS was given as a text."""
    inner = failure.inner
    if inner is None or not isinstance(failure.error, AssertionError):
        return None
    if inner.is_in("rclpy", "qos") and inner.function == "__init__":
        return _no_policy(inner)
    if not inner.is_in("rclpy", "qos") or not isinstance(inner.values.get("value"), str):
        return None
    if inner.function == "depth":
        return say("The depth of a QoS is a whole number without quotes, such as 10.")
    kind = f"{inner.function.title()}Policy"
    return say(
        "The policies of a QoS are no texts: {kind}.{name}, from rclpy.qos import {kind}.",
        kind=kind,
        name=str(inner.values["value"]).upper(),
    )


def _no_policy(level: TraceLevel) -> Words | None:
    """Say that a QoS has no such argument."""
    known = [each.lstrip("_") for each in getattr(level.values.get("self"), "__slots__", ())]
    name = next((each for each in level.values.get("kwargs", ()) if each not in known), "")
    if not name:
        return None
    meant = nearest(name, known)
    if meant:
        return say("{what} has no argument {name}; did you mean {meant}?", what="QoSProfile", name=name, meant=meant)
    return say("{what} has no argument {name}; it has: {known}.", what="QoSProfile", name=name, known=listed(known))


def text_for_number(failure: Failure) -> Words | None:
    """A function of ROS or of Python was given a number in quotes."""
    if failure.own is None or failure.is_own or not isinstance(failure.error, (TypeError, ValueError)):
        return None
    if "str" not in str(failure.error) and "digits" not in str(failure.error):
        return None
    for call in failure.all(ast.Call):
        for each in (*call.args, *(keyword.value for keyword in call.keywords)):
            value = failure.value(each)
            if isinstance(value, str) and isinstance(each, ast.Constant) and _is_number(value):
                return say(
                    "{call}: a number stands without quotes, {value}.", call=shown(call.func), value=value.strip()
                )
            words = of_text(shown(each), value) if isinstance(value, str) else None
            if words is not None:
                return words
    return None


def _is_number(text: str) -> bool:
    return re.fullmatch(r"\s*-?\d+(\.\d*)?\s*", text) is not None


def group(failure: Failure) -> Words | None:
    """The class of a callback group was handed over, and not a group."""
    for call in failure.all(ast.Call) if not failure.is_own else ():
        for each in (*call.args, *(keyword.value for keyword in call.keywords)):
            value = failure.value(each)
            if isinstance(value, type) and value.__module__ == "rclpy.callback_groups":
                return say("{what} is a class: the brackets are missing, {what}().", what=shown(each))
    return None


def not_callable(failure: Failure) -> Words | None:
    """A method was called where a callback had to be handed over."""
    found = called(failure)
    if found is None or "allable" not in str(failure.error) or "callback" not in found[1].values:
        return None
    if callable(found[1].values["callback"]):
        return None
    return not_handed_over(found[1].values["callback"])


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
                "The executor was given the class {name}: make a node of it first, executor.add_node({name}()).",
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
            "{call} takes an array of numpy, height × width × channels of uint8, and is given {given}.",
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
    return say('The f is missing in front of the name: f"{name}" puts the value of a variable there.', name=name)


RULES = (
    on_class, not_callable, group, policy, executor, transform, picture, substitution, annotated,
    text_for_number,
)  # fmt: skip

"""What `create_publisher` and its like are given: swapped, of another kind, or called."""

from __future__ import annotations

import ast
import inspect
import itertools
from typing import TYPE_CHECKING, Any

from launcher.faults.failure import (
    Failure,
    is_action_class,
    is_from,
    is_message,
    is_message_class,
    is_service_class,
    name_of,
    shown,
)
from launcher.faults.homes import home_of
from launcher.faults.remedy import of_message, parameter
from launcher.faults.rules.callbacks import SUBSCRIPTION, asks_for_other, not_handed_over
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable

    from launcher.faults.failure import TraceLevel
    from text.sentences import Words

FITS: dict[str, Callable[[Any], bool]] = {
    "msg_type": is_message_class,
    "srv_type": is_service_class,
    "action_type": is_action_class,
    "topic": lambda value: isinstance(value, str),
    "srv_name": lambda value: isinstance(value, str),
    "action_name": lambda value: isinstance(value, str),
    "callback": callable,
    "execute_callback": callable,
    "qos_profile": lambda value: is_from(value, "rclpy", "QoSProfile") or (type(value) is int and value >= 0),
    "timer_period_sec": lambda value: type(value) in (int, float) and value >= 0,
    "node": lambda value: is_from(value, "rclpy", "Node"),
    "name": lambda value: isinstance(value, str),
    "node_name": lambda value: isinstance(value, str),
}
"""What the arguments of rclpy's functions have to be, by rclpy's own names of them."""
_EXAMPLES = {
    "msg_type": ("std_msgs.msg", "Float32"),
    "srv_type": ("example_interfaces.srv", "AddTwoInts"),
    "action_type": ("example_interfaces.action", "Fibonacci"),
}
_MAKERS = ("ActionClient", "ActionServer")
_NAMED = ("topic", "srv_name", "action_name", "name", "node_name")


def arguments(failure: Failure) -> Words | None:
    """A function of rclpy that makes something was given other things than it needs."""
    level = _maker(failure)
    if level is None:
        return None
    given = {name: level.values[name] for name in FITS if name in _parameters(level)}
    wrong = [name for name, value in given.items() if not FITS[name](value)]
    if not wrong:
        return _callback(failure, level, given)
    orders = itertools.permutations(wrong) if len(wrong) > 1 else ()
    if any(_fits_all(wrong, given, order) for order in orders):
        return say(
            "The arguments are in another order: {call}({arguments}).",
            call=_name(level),
            arguments=", ".join(_required(level)),
        )
    if is_from(given[wrong[0]], "rclpy", "Parameter"):
        return parameter(_written(failure, given[wrong[0]]))
    return _wrong(level, wrong[0], given[wrong[0]])


def _written(failure: Failure, value: object) -> str:
    """Return the learner's expression for what was handed over."""
    for call in failure.all(ast.Call):
        for each in (*call.args, *(keyword.value for keyword in call.keywords)):
            if failure.value(each) is value:
                return shown(each)
    return "x"


def _callback(failure: Failure, level: TraceLevel, given: dict[str, Any]) -> Words | None:
    if "callback" not in given or level.function != "create_subscription":
        return None
    callback = given["callback"]
    if isinstance(failure.error, ValueError) and inspect.isbuiltin(callback):
        return say(
            "rclpy asks what a callback takes, and Python does not tell it of {name}: write lambda msg: {name}(msg).",
            name=callback.__name__,
        )
    return asks_for_other(SUBSCRIPTION, callback)


def _maker(failure: Failure) -> TraceLevel | None:
    """Return the level of rclpy's function that the learner's own line has called."""
    level = next(failure.below("rclpy"), None)
    if level is None:
        return None
    me = level.values.get("self")
    makes = level.function.startswith(("create_", "declare_parameter", "get_parameter"))
    if makes and is_from(me, "rclpy", "Node"):
        return level
    if level.function == "__init__" and type(me).__name__ in (*_MAKERS, "Node"):
        return level
    return level if level.function == "__init__" and is_from(me, "rclpy", "Node") else None


def _parameters(level: TraceLevel) -> tuple[str, ...]:
    code = level.frame.f_code
    return code.co_varnames[: code.co_argcount]


def _required(level: TraceLevel) -> list[str]:
    """Return rclpy's own names of the arguments that have to be given."""
    me = level.values["self"]
    signature = inspect.signature(getattr(type(me), level.function))
    names = [
        each.name
        for each in signature.parameters.values()
        if each.default is each.empty and each.kind is each.POSITIONAL_OR_KEYWORD
    ]
    return names[1:]


def _name(level: TraceLevel) -> str:
    if level.function == "__init__":
        return type(level.values["self"]).__name__
    return f"self.{level.function}"


def _fits_all(wrong: list[str], given: dict[str, Any], order: tuple[str, ...]) -> bool:
    return all(FITS[name](given[other]) for name, other in zip(wrong, order, strict=True))


def _wrong(level: TraceLevel, name: str, value: Any) -> Words | None:  # noqa: ANN401
    call = _name(level)
    if name in ("callback", "execute_callback"):
        return not_handed_over() if value is None else _no_callback(call, value)
    if name in _NAMED:
        return say(
            "{call}: {name} is a text in quotes, and is given {given}.",
            call=call,
            name=name,
            given=name_of(type(value)),
        )
    if name == "qos_profile":
        return say(
            "{call}: qos_profile is the queue depth, a whole number without quotes such as 10, or a"
            " QoSProfile(depth=10, …).",
            call=call,
        )
    if name == "timer_period_sec" and type(value) in (int, float):
        return say("{call}: the period is a number of seconds, and not below 0.", call=call)
    if name == "timer_period_sec" and is_message(value):
        return of_message(name, type(value))
    if name == "timer_period_sec":
        return say(
            "{call}: the period comes first, as a number of seconds: self.create_timer(0.5, self.on_timer).",
            call=call,
        )
    if name == "node":
        return say("{call}: the node comes first: {call}(self, …).", call=call)
    return _wrong_type(call, name, value)


def _no_callback(call: str, value: Any) -> Words:  # noqa: ANN401
    return say(
        "{call}: callback is a method, handed over without brackets, and is given {given}.",
        call=call,
        given=name_of(type(value)),
    )


def _wrong_type(call: str, name: str, value: Any) -> Words | None:  # noqa: ANN401
    if is_message(value):
        return say(
            "{call}: the type is handed over as it is, without brackets: {type}.",
            call=call,
            type=name_of(type(value)),
        )
    if inspect.ismodule(value):
        return say(
            "{call}: {module} is a module; the type is a class in it: {module}.String.",
            call=call,
            module=value.__name__,
        )
    if isinstance(value, str):
        kind = value.rpartition("/")[2]
        home = home_of(kind)
        if not home:
            home, kind = _EXAMPLES[name]
        return say(
            "{call}: the type is a class that is imported, and stands without quotes: from {home} import {type}.",
            call=call,
            home=home,
            type=kind,
        )
    kinds = (
        (is_service_class, say("a service")),
        (is_action_class, say("an action")),
        (is_message_class, say("a message")),
    )
    for fits, kind in kinds:
        if fits(value):
            return say(
                "{call}: {type} is the type of {kind}, which does not go with it: a topic has"
                " messages (.msg), a service .srv, an action .action.",
                call=call,
                type=value.__name__,
                kind=kind,
            )
    return say(
        "{call}: {name} is a class that is imported, such as from std_msgs.msg import Float32.", call=call, name=name
    )


RULES = (arguments,)

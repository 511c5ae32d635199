"""Parameters: set, declared and asked for by something that is none, and what is told of them."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING

from launcher.faults.failure import Failure, is_from, name_of
from launcher.faults.remedy import listed
from text.sentences import say

if TYPE_CHECKING:
    from text.sentences import Words

_SETTERS = ("set_parameters", "set_parameters_atomically", "_check_undeclared_parameters")
_LISTS = ("declare_parameters", "get_parameters")


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


def listing(failure: Failure) -> Words | None:
    """Parameters were declared or asked for by something that is no list of them."""
    level = next(
        (
            e
            for e in failure.below("rclpy")
            if e.function in ("declare_parameters", "get_parameters")
        ),
        None,
    )
    if level is None:
        return None
    names, pairs = level.values.get("names"), level.values.get("parameters")
    if level.function == "get_parameters" and isinstance(names, str):
        return say("get_parameters takes a list of names: [{name}].", name=repr(names))
    fits = isinstance(pairs, (list, tuple)) and all(isinstance(e, (list, tuple)) for e in pairs)
    if level.function == "declare_parameters" and not fits:
        return say(
            "declare_parameters takes a list of pairs, each in brackets of its own:"
            " [('speed', 1.0), ('turn', 0.5)]."
        )
    return None


def told(failure: Failure) -> Words | None:
    """A callback that is told of new values does not take them."""
    inner = failure.inner
    if inner is None or not isinstance(failure.error, TypeError):
        return None
    callback, code = inner.values.get("callback"), inner.frame.f_code
    given = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
    # What makes timers and the like has the callback as an argument, and does not call it.
    if not inner.is_in("rclpy", "node") or not callable(callback) or "callback" in given:
        return None
    name = getattr(callback, "__name__", "")
    try:
        inspect.signature(callback).bind([])
    except (TypeError, ValueError) as error:
        if isinstance(error, ValueError) and inspect.isbuiltin(callback):
            return None
        return say(
            "The callback gets a list of the parameters, and returns SetParametersResult:"
            " def {name}({me}params).",
            name=name if name.isidentifier() else "on_change",
            me="self, " if inspect.ismethod(callback) else "",
        )
    return None


RULES = (listing, parameters, parameter_value, told)

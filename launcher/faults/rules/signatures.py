"""Calls with other arguments than the function's own signature asks for."""

from __future__ import annotations

import ast
import inspect
from typing import Any

from launcher.faults.failure import UNKNOWN, Failure, is_message_class, shown
from launcher.faults.remedy import listed
from text.sentences import Words, say
from text.suggestions import nearest


def arguments(failure: Failure) -> Words | None:
    """A function was called with other arguments than it asks for."""
    for call in failure.refused_calls():
        function = failure.called(call)
        if function is UNKNOWN or not callable(function):
            continue
        words = _misfit(failure, call, function)
        if words is not None:
            return words
    return None


def _misfit(failure: Failure, call: ast.Call, function: Any) -> Words | None:  # noqa: ANN401
    if any(isinstance(each, ast.Starred) for each in call.args) or is_message_class(function):
        return None
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):
        return _without_self(call, function)
    names = [each.arg for each in call.keywords if each.arg is not None]
    if len(names) < len(call.keywords):
        return None
    unbound = not isinstance(call.func, ast.Attribute) or failure.value(call.func) is not UNKNOWN
    given = (*range(len(call.args) + (not unbound)),)
    try:
        signature.bind(*given, **dict.fromkeys(names))
    except TypeError:
        return _unbound(failure, call, function, signature) or _says(
            call, function, signature, names, called_on=not unbound
        )
    return None


def _unbound(
    failure: Failure,
    call: ast.Call,
    function: Any,  # noqa: ANN401
    signature: inspect.Signature,
) -> Words | None:
    """Say that a method was called on its class, or has no self."""
    me = failure.named("self")
    if isinstance(call.func, ast.Attribute) and call.func.attr != "__init__":
        of = failure.value(call.func.value)
        if isinstance(of, type) and me is not UNKNOWN and isinstance(me, of):
            return say(
                "{owner} is the class: the node itself is self, self.{name}(…).",
                owner=shown(call.func.value),
                name=call.func.attr,
            )
    on_class = isinstance(call.func, ast.Attribute) and isinstance(failure.value(call.func.value), type)
    if on_class and next(iter(signature.parameters), "") == "self":
        assert isinstance(call.func, ast.Attribute)
        return say(
            "{name} belongs to an object, and {owner} is the class: make one first, {owner}().",
            name=call.func.attr,
            owner=shown(call.func.value),
        )
    return _without_self(call, function)


def _without_self(call: ast.Call, function: Any) -> Words | None:  # noqa: ANN401
    inner = getattr(function, "__func__", None)
    code = getattr(inner, "__code__", None)
    if code is None:
        return None
    names = code.co_varnames[: code.co_argcount]
    if not names or (names[0] != "self" and len(call.args) == code.co_argcount):
        return say(
            "The first argument of a method is self: def {name}({arguments}).",
            name=function.__name__,
            arguments=", ".join(("self", *names)),
        )
    return None


def _says(
    call: ast.Call,
    function: Any,  # noqa: ANN401
    signature: inspect.Signature,
    names: list[str],
    *,
    called_on: bool,
) -> Words:
    parameters = list(signature.parameters.values())[int(called_on) :]
    known = [each.name for each in parameters]
    takes = ", ".join(each.name for each in parameters if each.default is each.empty and each.kind in (0, 1))
    what = shown(call.func)
    extra = next((name for name in names if name not in known), "")
    if extra == "queue_size" and "qos_profile" in known:
        return say(
            "queue_size is of ROS 1; here the number alone stands at the end: {what}({takes}).",
            what=what,
            takes=takes,
        )
    if extra:
        meant = next((each for each in known if each.startswith(extra)), "") or nearest(extra, known)
        if meant:
            return say("{what} has no argument {name}; did you mean {meant}?", what=what, name=extra, meant=meant)
        return say(
            "{what} has no argument {name}; it has: {known}.", what=what, name=extra, known=listed(known) or "-"
        )
    missing = [
        each.name
        for each in parameters[len(call.args) :]
        if each.default is each.empty and each.kind in (0, 1, 3) and each.name not in names
    ]
    if missing == ["qos_profile"]:
        return say(
            "The last argument is missing, the queue depth: {what}({takes}), such as 10 for qos_profile.",
            what=what,
            takes=takes,
        )
    if missing:
        return say(
            "{what} is called without {missing}; it takes {takes}.",
            what=what,
            missing=", ".join(missing),
            takes=takes,
        )
    by_name = [each.name for each in parameters if each.kind == each.KEYWORD_ONLY]
    if function.__name__ == "QoSProfile":
        by_name = ["depth"]
    if shown(call.func) == "rclpy.init" and isinstance(call.args[0], ast.Constant):
        return say(
            'rclpy.init takes no name: rclpy.init(). The name is given to the node, super().__init__("my_node").'
        )
    if not takes and by_name:
        return say(
            "{what} takes its values by name: {what}({name}={value}).",
            what=what,
            name=by_name[0],
            value=shown(call.args[0]),
        )
    places = ", ".join(each.name for each in parameters if each.kind in (0, 1))
    given = listed([shown(each) for each in call.args])
    if not places and given:
        return say("{what} takes nothing, and is given {given}.", what=what, given=given)
    return say("{what} takes {takes}, and is given {given}.", what=what, takes=places, given=given or say("nothing"))

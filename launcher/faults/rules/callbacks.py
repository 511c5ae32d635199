"""Callbacks: asking for other arguments than rclpy gives them, returning something else."""

from __future__ import annotations

import ast
import inspect
from typing import TYPE_CHECKING, Any

from launcher.faults.failure import Failure, is_from, is_message, name_of, shown
from text.sentences import say

if TYPE_CHECKING:
    from text.sentences import Words

TIMER = "tmr"
SUBSCRIPTION = "sub"
SERVICE = "srv"
FEEDBACK = "feedback"
GOAL = "goal"
_ARGUMENTS = {
    TIMER: "self", SUBSCRIPTION: "self, msg", SERVICE: "self, request, response",
    FEEDBACK: "self, msg", GOAL: "self, goal_handle",
}  # fmt: skip
_OWNERS = (TIMER, SUBSCRIPTION, SERVICE)
"""The names of the local variables in rclpy's executors that hold what has called back."""


def called_back(failure: Failure) -> tuple[str, Any] | None:
    """Return what rclpy could not call, and of which kind the callback is."""
    inner = failure.inner
    if inner is None or not isinstance(failure.error, TypeError) or not inner.is_in("rclpy"):
        return None
    if inner.function == "await_or_execute" and inner.is_in("rclpy", "executors"):
        above = failure.levels[-2] if len(failure.levels) > 1 else inner
        if above.is_in("rclpy", "action/client"):
            return FEEDBACK, inner.values["callback"]
        if above.is_in("rclpy", "action/server"):
            return GOAL, inner.values["callback"]
        for level in failure.levels[-2::-1]:
            for owner in _OWNERS:
                if owner in level.values and level.is_in("rclpy", "executors"):
                    return owner, inner.values["callback"]
    if inner.function == "callback" and inner.is_in("rclpy", "subscription"):
        return SUBSCRIPTION, inner.values.get("value")
    return None


def place_of(failure: Failure) -> tuple[str, int] | None:
    """Return where the callback is defined that rclpy could not call."""
    found = called_back(failure) or _answering(failure) or _resulting(failure)
    code = getattr(getattr(found and found[1], "__func__", found and found[1]), "__code__", None)
    if code is None or code.co_filename.rpartition("/")[0] != failure.folder:
        return None
    return code.co_filename, code.co_firstlineno


def signature(failure: Failure) -> Words | None:
    """A callback cannot be called with what rclpy gives it."""
    found = called_back(failure)
    if found is None:
        return None
    owner, callback = found
    if not callable(callback):
        return not_handed_over(callback)
    return asks_for_other(owner, callback)


def not_handed_over(instead: object = None) -> Words:
    """Say that a method was called where it had to be handed over, or written in quotes."""
    if isinstance(instead, str):
        return say(
            "The callback is a text, and has to be the method itself: self.{name}, without quotes.",
            name=instead if instead.isidentifier() else "on_timer",
        )
    return say(
        "The method was called where it had to be handed over: write its name without brackets, self.on_timer."
    )


def asks_for_other(owner: str, callback: Any) -> Words | None:  # noqa: ANN401
    """Say which arguments a callback gets, None if it takes them."""
    given = {TIMER: 0, SUBSCRIPTION: 1, SERVICE: 2, FEEDBACK: 1, GOAL: 1}[owner]
    try:
        inspect.signature(callback).bind(*range(given))
    except ValueError:
        if inspect.isbuiltin(callback):
            return None
        # Of a method without any parameter, not even self.
    except TypeError:
        pass
    else:
        return None
    function = getattr(callback, "__func__", None)
    name = getattr(callback, "__name__", "callback")
    me = "self, " if function is not None else ""
    if function is not None and not function.__code__.co_argcount:
        return say(
            "The first argument of a method is self: def {name}({arguments}).", name=name, arguments=_ARGUMENTS[owner]
        )
    if owner == TIMER:
        return say("A timer gives its callback nothing: def {name}({me}).", name=name, me=me.rstrip(", "))
    if owner == SUBSCRIPTION:
        return say(
            "A subscription gives its callback the message, and nothing else: def {name}({me}msg).", name=name, me=me
        )
    if owner == FEEDBACK:
        return say(
            "An action's client gives its feedback callback one message, with the feedback in it:"
            " def {name}({me}msg).",
            name=name,
            me=me,
        )
    if owner == GOAL:
        return say(
            "An action's server gives its callback the goal's handle, and nothing else: def {name}({me}goal_handle).",
            name=name,
            me=me,
        )
    return say("A service gives its callback two things: def {name}({me}request, response).", name=name, me=me)


def _answering(failure: Failure) -> tuple[str, Any] | None:
    """Return the callback of a service that has returned something else than its response."""
    inner = failure.inner
    if inner is None or inner.function != "send_response" or not inner.is_in("rclpy", "service"):
        return None
    for level in failure.levels[-2::-1]:
        if SERVICE in level.values:
            return SERVICE, level.values[SERVICE].callback
    return None


def _resulting(failure: Failure) -> tuple[str, Any] | None:
    """Return the callback of an action's server that has returned something else than a result."""
    inner = failure.inner
    if inner is None or not type(inner.values.get("self")).__name__.endswith("_GetResult_Response"):
        return None
    for level in failure.levels[::-1]:
        if is_from(level.values.get("self"), "rclpy", "ActionServer"):
            return GOAL, level.values["self"]._execute_callback  # noqa: SLF001 - nobody else knows
    return None


def response(failure: Failure) -> Words | None:
    """The callback of a service has not returned its response."""
    inner = failure.inner
    found = _answering(failure)
    if inner is None or found is None or not isinstance(failure.error, TypeError):
        return None
    answer, name = inner.values["response"], getattr(found[1], "__name__", "callback")
    if answer is None:
        return say("{name} has to return the response in every case: return response.", name=name)
    if inspect.iscoroutine(answer):
        return None
    if isinstance(answer, type):
        return say(
            "{name} returns the class {type}, and not the response: fill response, and write return response.",
            name=name,
            type=name_of(answer),
        )
    return say(
        "{name} has to return the response, and returns {given}: fill response, and write return response.",
        name=name,
        given=name_of(type(answer)) if is_message(answer) else type(answer).__name__,
    )


def swapped(failure: Failure) -> Words | None:
    """The callback of a service has its request and its response in another order."""
    if not isinstance(failure.error, AttributeError) or failure.own is None or not failure.is_own:
        return None
    for name, value in failure.own.values.items():
        kind = type(value).__name__ if is_message(value) else ""
        if (name.startswith("res") and kind.endswith("_Request")) or (
            name.startswith("req") and kind.endswith("_Response")
        ):
            return say(
                "A service hands over the request first, and then the response: def {name}(self, request, response).",
                name=failure.own.function,
            )
    return None


def done(failure: Failure) -> Words | None:
    """A callback of a future does not take the future."""
    inner = failure.inner
    if inner is None or not isinstance(failure.error, TypeError) or not inner.is_in("rclpy", "task"):
        return None
    method = _unfit_for_done(failure)
    if method is None:
        return None
    return say(
        "A done callback gets the future, and nothing else: def {name}({me}future).",
        name=method.name,
        me="self, " if _is_method(method) else "",
    )


def _unfit_for_done(failure: Failure) -> ast.FunctionDef | None:
    """Return the function that `add_done_callback` was given, and that does not take one thing."""
    given = {
        shown(each.args[0]).rpartition(".")[2]
        for each in ast.walk(failure.tree)
        if isinstance(each, ast.Call) and shown(each.func).endswith(".add_done_callback") and each.args
    }
    for each in ast.walk(failure.tree):
        if isinstance(each, ast.FunctionDef) and each.name in given:
            wanted = len(each.args.args) - len(each.args.defaults)
            if wanted != 1 + _is_method(each):
                return each
    return None


def _is_method(function: ast.FunctionDef) -> bool:
    return isinstance(getattr(function, "parent", None), ast.ClassDef)


RULES = (signature, response, swapped, done)

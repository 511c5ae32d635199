"""Callbacks: asking for other arguments than rclpy gives them, returning something else."""

from __future__ import annotations

import ast
import inspect
from pathlib import Path
from typing import Any

from launcher.faults.failure import Failure, is_from, is_message, name_of, shown
from text.i18n import N_
from text.sentences import Words, say

TIMER, SUBSCRIPTION, SERVICE = "tmr", "sub", "srv"
"""The names of the local variables in rclpy's executors that hold what has called back."""
FEEDBACK, GOAL = "feedback", "goal"
_ARGUMENTS = {
    TIMER: "self", SUBSCRIPTION: "self, msg", SERVICE: "self, request, response",
    FEEDBACK: "self, msg", GOAL: "self, goal_handle",
}  # fmt: skip


def _called_back(failure: Failure) -> tuple[str, Any] | None:
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
            for owner in (TIMER, SUBSCRIPTION, SERVICE):
                if owner in level.values and level.is_in("rclpy", "executors"):
                    return owner, inner.values["callback"]
    if inner.function == "callback" and inner.is_in("rclpy", "subscription"):
        return SUBSCRIPTION, inner.values.get("value")
    return None


def place_of(failure: Failure, program: str) -> tuple[str, int] | None:
    """Return where the callback is defined that rclpy could not call, or the thread begun that has failed."""
    found = _called_back(failure) or _answering(failure) or _resulting(failure)
    code = getattr(getattr(found and found[1], "__func__", found and found[1]), "__code__", None)
    if code is None:
        return _thread(failure, program)
    return (code.co_filename, code.co_firstlineno) if code.co_filename.startswith(f"{failure.folder}/") else None


def _thread(failure: Failure, program: str) -> tuple[str, int] | None:
    """Return where a program starts the thread of a failure in which no line is its own."""
    begins = [each for each in failure.levels if not each.file.endswith("/threading.py")]
    if failure.own is not None or not begins or begins[0] is failure.levels[0]:
        return None
    try:
        tree = ast.parse(Path(program).read_bytes())
    except (OSError, SyntaxError, ValueError):
        return None
    found = [
        each.lineno
        for each in ast.walk(tree)
        if isinstance(each, ast.Call)
        for word in each.keywords
        if word.arg == "target" and shown(word.value).rpartition(".")[2] == begins[0].function
    ]
    return (program, min(found)) if found else None


def signature(failure: Failure) -> Words | None:
    """A callback cannot be called with what rclpy gives it."""
    found = _called_back(failure)
    if found is None:
        return None
    return asks_for_other(*found) if callable(found[1]) else not_handed_over(found[1])


def not_handed_over(instead: object = None) -> Words:
    """Say that a method was called where it had to be handed over, or written in quotes."""
    if isinstance(instead, str):
        phrase = N_("The callback is a text, and has to be the method itself: self.{name}, without quotes.")
        return say(phrase, name=instead if instead.isidentifier() else "on_timer")
    return say(
        "The method was called where it had to be handed over: write its name without brackets, self.on_timer."
    )


def asks_for_other(owner: str, callback: Any) -> Words | None:
    """Say which arguments a callback gets, None if it takes them."""
    function, name = getattr(callback, "__func__", None), getattr(callback, "__name__", "callback")
    me = "self, " if function is not None else ""
    try:
        inspect.signature(callback).bind(*range(_ARGUMENTS[owner].count(",")))
    except (TypeError, ValueError):
        if inspect.isbuiltin(callback):
            return None
    else:
        return None
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
        phrase = N_(
            "An action's client gives its feedback callback one message, with the feedback in it:"
            " def {name}({me}msg)."
        )
        return say(phrase, name=name, me=me)
    if owner == GOAL:
        phrase = N_(
            "An action's server gives its callback the goal's handle, and nothing else: def {name}({me}goal_handle)."
        )
        return say(phrase, name=name, me=me)
    return say("A service gives its callback two things: def {name}({me}request, response).", name=name, me=me)


def _answering(failure: Failure) -> tuple[str, Any] | None:
    """Return the callback of a service that has returned something else than its response."""
    inner = failure.inner
    if inner is None or inner.function != "send_response" or not inner.is_in("rclpy", "service"):
        return None
    services = (each.values[SERVICE] for each in failure.levels[-2::-1] if SERVICE in each.values)
    return next(((SERVICE, each.callback) for each in services), None)


def _resulting(failure: Failure) -> tuple[str, Any] | None:
    """Return the callback of an action's server that has returned something else than a result."""
    inner = failure.inner
    if inner is None or not type(inner.values.get("self")).__name__.endswith("_GetResult_Response"):
        return None
    found = (each.values.get("self") for each in failure.levels[::-1])
    server: Any = next((each for each in found if is_from(each, "rclpy", "ActionServer")), None)
    return None if server is None else (GOAL, server._execute_callback)


def response(failure: Failure) -> Words | None:
    """The callback of a service has not returned its response."""
    inner, found = failure.inner, _answering(failure)
    if inner is None or found is None or not isinstance(failure.error, TypeError):
        return None
    answer, name = inner.values["response"], getattr(found[1], "__name__", "callback")
    if answer is None:
        return say("{name} has to return the response in every case: return response.", name=name)
    if isinstance(answer, type):
        phrase = N_(
            "{name} returns the class {type}, and not the response: fill response, and write return response."
        )
        return say(phrase, name=name, type=name_of(answer))
    phrase = N_("{name} has to return the response, and returns {given}: fill response, and write return response.")
    return say(phrase, name=name, given=name_of(type(answer)) if is_message(answer) else type(answer).__name__)


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
    given = {
        shown(each.args[0]).rpartition(".")[2]
        for each in ast.walk(failure.tree)
        if isinstance(each, ast.Call) and shown(each.func).endswith(".add_done_callback") and each.args
    }
    for each in ast.walk(failure.tree):
        if isinstance(each, ast.FunctionDef) and each.name in given:
            is_method = isinstance(getattr(each, "parent", None), ast.ClassDef)
            if len(each.args.args) - len(each.args.defaults) != 1 + is_method:
                phrase = N_("A done callback gets the future, and nothing else: def {name}({me}future).")
                return say(phrase, name=each.name, me="self, " if is_method else "")
    return None

"""The logger of a node: several things for one text, a number, an option that there is none."""

from __future__ import annotations

import ast
import re

from launcher.faults.failure import Failure, is_from, name_of, shown
from text.sentences import Words, say
from text.suggestions import nearest

_PLACE = re.compile(r"%[-+ 0#]*\d*(?:\.\d+)?[dfsgeixr]")
"""Where a value is put into a text by the operator %."""
_LOGS = ("debug", "info", "warn", "warning", "error", "fatal")
_OPTIONS = ("throttle_duration_sec", "throttle_time_source_type", "skip_first", "once", "name")


def several(failure: Failure) -> Words | None:
    """A method of the logger was given several things, as print takes them."""
    for call in failure.refused_calls():
        if (
            isinstance(call.func, ast.Attribute)
            and call.func.attr in _LOGS
            and len(call.args) != 1
            and ("logger" in shown(call.func) or is_from(failure.value(call.func.value), "rclpy", "RcutilsLogger"))
        ):
            text = failure.value(call.args[0]) if call.args else ""
            if isinstance(text, str) and _PLACE.search(text):
                return say(
                    "The logger does not fill in {place} as printf does: {call}({text} % ({values})).",
                    place=_PLACE.findall(text)[0],
                    call=shown(call.func),
                    text=shown(call.args[0]),
                    values=", ".join(map(shown, call.args[1:])),
                )
            if not call.args:
                return say('The text is missing: {call}("…").', call=shown(call.func))
            return say(
                'The logger takes one text, not several as print does: {call}(f"{text} {{{value}}}").',
                call=shown(call.func),
                text=_text_of(call.args[0]),
                value=shown(call.args[1]),
            )
    return None


def unfit(failure: Failure) -> Words | None:
    """The logger was given a number, or an option that it has not."""
    inner, call = failure.inner, failure.first(ast.Call)
    if inner is None or call is None or not isinstance(failure.error, TypeError):
        return None
    if not inner.is_in("rclpy", "rcutils_logger"):
        return None
    what = shown(call.func)
    unknown = next((each.arg for each in call.keywords if each.arg not in (*_OPTIONS, None)), None)
    if unknown is not None:
        meant = next((each for each in _OPTIONS if each.startswith(unknown)), "")
        meant = meant or nearest(unknown, _OPTIONS)
        if meant:
            return say("{what} has no argument {name}; did you mean {meant}?", what=what, name=unknown, meant=meant)
        return say(
            "{what} has no argument {name}; it has: {known}.", what=what, name=unknown, known=", ".join(_OPTIONS)
        )
    message = inner.values.get("message")
    if call.args and not isinstance(message, str):
        return say(
            "The logger takes a text, and {what} is of type {type}: {call}(str({what})).",
            what=shown(call.args[0]),
            type=name_of(message if isinstance(message, type) else type(message)),
            call=what,
        )
    return None


def _text_of(node: ast.expr) -> str:
    value = node.value if isinstance(node, ast.Constant) else None
    return value if isinstance(value, str) else "{" + shown(node) + "}"

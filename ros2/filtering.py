"""`--filter`: an expression in Python that says which messages are meant."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from graph.messages.fields import fields_of
from graph.messages.making import no_such_field
from ros2.options import UsageError
from text.i18n import localized
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable

MESSAGE = "m"
LONGEST = 200
"""Characters of an expression that an error repeats."""


def wanted(expression: str | None) -> Callable[[Any], bool]:
    """Return whether a message is wanted; UsageError for what is not an expression, or fails."""
    if expression is None:
        return lambda _message: True
    try:
        code = compile(expression.lstrip(), "<filter>", "eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        before = len(expression) - len(expression.lstrip())
        raise _refused(expression, _unreadable(error, before)) from error

    def is_wanted(message: Any) -> bool:  # noqa: ANN401 - generated
        try:
            # Whoever types the command may run any Python here anyway.
            return bool(eval(code, {}, {MESSAGE: message}))
        except Exception as error:
            raise _refused(expression, _failed(error)) from error

    return is_wanted


def _refused(expression: str, reason: str) -> UsageError:
    shown = expression if len(expression) <= LONGEST else f"{expression[: LONGEST - 1]}…"
    return UsageError(f"Invalid filter expression '{shown}': {localized(reason)}")


def _unreadable(error: Exception, before: int) -> str:
    """Say what Python says, and where; `before`: blanks at the begin."""
    if isinstance(error, (RecursionError, MemoryError)):
        return say("is nested too deeply")
    offset, text = getattr(error, "offset", None), getattr(error, "text", None)
    said = getattr(error, "msg", str(error))
    if offset == 0:
        # So it tells that the expression ends too early.
        offset = len(text or "") + 1
    if offset:
        return say("column {column}: {reason}", reason=said, column=before + offset)
    return said


def _failed(error: Exception) -> str:
    if isinstance(error, NameError):
        return say("{name} is unknown: the message is called m, and a field of it is such as m.data", name=error.name)
    of = getattr(error, "obj", None)
    if isinstance(error, AttributeError) and hasattr(of, "get_fields_and_field_types"):
        known = [name for name, _kind in fields_of(type(of))]
        name = str(error.name)
        return f"{name}: {localized(no_such_field(name, known))}"
    return f"{type(error).__name__}: {error}"

"""What is already wrong with a response of an LLM of which only the beginning has come.

The beginning is cut behind its last whole command, and closed; what is missing from the response as
a whole may still come, and is no mistake.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robot.commands.schema import CommandError, parse_llm
from robot.commands.wrapping import straightened, unwrapped

if TYPE_CHECKING:
    from robot.commands.schema import Problem

_CLOSING = {"{": "}", "[": "]"}
_COMMAND_LEVEL = 2
"""Brackets that are open between two commands: that of the response, and that of the list."""


def so_far(text: str) -> tuple[int, tuple[Problem, ...]]:
    """Return how many whole commands have come, and the problems that no continuation can fix."""
    text = straightened(unwrapped(text, whole=False))
    begun = text.lstrip()
    if not begun.startswith("{"):
        # Thoughts or words: a fence or </think> may still fix them.
        return 0, ()
    try:
        response = parse_llm(_closed(text))
    except CommandError as error:
        wrong = tuple(problem for problem in error.problems if not _may_still_come(problem))
        return 0, wrong
    return len(response.commands), ()


def _may_still_come(problem: Problem) -> bool:
    return problem.code == "missing" and problem.field in ("thought", "commands")


def _closed(text: str) -> str:
    """Return the beginning up to the last place between commands, with all brackets closed."""
    stack: list[str] = []
    cut, closing = 0, ""
    quote, escaped = "", False
    for at, character in enumerate(text):
        if quote:
            quote = quote if escaped or character != quote else ""
            escaped = not escaped and character == "\\"
        elif character in "\"'":
            quote = character
        elif character in _CLOSING:
            stack.append(_CLOSING[character])
            cut, closing = _cut(stack, at + 1) or (cut, closing)
        elif character in "]}":
            if not stack or stack.pop() != character:
                # Whatever follows, this is wrong: the check itself says what is.
                return text[: at + 1]
            cut, closing = _cut(stack, at + 1) or (cut, closing)
        elif character == ",":
            cut, closing = _cut(stack, at) or (cut, closing)
    return text if not stack and cut else text[:cut] + closing


def _cut(stack: list[str], at: int) -> tuple[int, str] | None:
    return (at, "".join(reversed(stack))) if len(stack) <= _COMMAND_LEVEL else None

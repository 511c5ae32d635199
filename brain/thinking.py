"""A question to a model until the answer is one that Deck accepts, with one chance to repair it.

Whatever a server promises about the form of its answers, each is checked here, by the same function
that checks it again in `llm_parser`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Generic, TypeVar

from brain.faults import FaultKind, ModelError
from robot.commands.problems import CommandError
from robot.commands.wrapping import unwrapped
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from typing import Any

    from brain.budget import TokenUsage
    from brain.client import Message
    from brain.ladder import Ladder

T = TypeVar("T")
_REPAIR = """\
That answer is not valid, and nothing of it was done:
{problems}
Answer again with the whole JSON object, corrected."""


@dataclass(frozen=True)
class Thought(Generic[T]):
    """An answer of the model that has passed the check, if need be after one repair."""

    value: T
    text: str
    """Its JSON."""
    usages: tuple[TokenUsage, ...]
    """Of the answer, and before it of the one that had to be repaired."""


async def think(
    ladder: Ladder,
    schema: Mapping[str, Any],
    messages: Sequence[Message],
    check: Callable[[str], T],
    on_text: Callable[[str], None] = lambda _: None,
    on_repair: Callable[[str], None] = lambda _: None,
) -> Thought[T]:
    """Ask, check, and ask once more if the first answer is not valid.

    `check` returns the value of a text, or raises CommandError; `on_text` gets the pieces of the
    answer as they come, `on_repair` what was wrong with the first one, before the second begins.

    Raises:
        ModelError: if there is no valid answer.
    """
    first = await ladder.ask(schema, messages, on_text)
    text = unwrapped(first.text).strip()
    try:
        return Thought(check(text), text, (first.usage,))
    except CommandError as error:
        problems = "\n".join(map(str, error.problems))
    on_repair(problems)
    again = [
        *messages,
        {"role": "assistant", "content": first.text},
        {"role": "user", "content": _REPAIR.format(problems=problems)},
    ]
    second = await ladder.ask(schema, again, on_text)
    text = unwrapped(second.text).strip()
    try:
        return Thought(check(text), text, (first.usage, second.usage))
    except CommandError as error:
        # The server may have been replaced by one that ignores what the old one obeyed.
        ladder.forget()
        words = say("the answer is not valid, nor is the second: {problem}", problem=str(error))
        raise ModelError(FaultKind.SHAPE, words) from None

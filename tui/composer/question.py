"""A question to a model that is under way: what has come, and what is wrong with it already."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from robot.commands.schema import CommandError, parse_llm, so_far
from robot.commands.wrapping import THINK, unwrapped

if TYPE_CHECKING:
    from brain.budget import TokenUsage
    from robot.commands.schema import Problem


@dataclass
class ModelQuestion:
    """What was asked, and the answer as far as it has come."""

    words: str
    model: str
    begun_s: float = field(default_factory=time.monotonic)
    """Monotonic clock."""
    refused: tuple[Problem, ...] = ()
    """What was wrong with the first answer, if there is a second."""
    _pieces: list[str] = field(default_factory=list)

    @property
    def age_s(self) -> float:
        """Seconds since it was asked."""
        return time.monotonic() - self.begun_s

    def take(self, piece: str) -> None:
        self._pieces.append(piece)

    def repair(self, _problems: str) -> None:
        """The answer was refused, and another one begins."""
        try:
            parse_llm(self.text)
        except CommandError as error:
            self.refused = error.problems
        self._pieces.clear()

    @property
    def has_begun(self) -> bool:
        """Whether any of the answer has come, even if only thoughts."""
        return bool(self._pieces)

    @property
    def text(self) -> str:
        """The JSON so far, without what models like to put around it."""
        text = unwrapped("".join(self._pieces), whole=False).strip()
        return "" if text.startswith(THINK) else text

    def so_far(self) -> tuple[int, tuple[Problem, ...]]:
        """Return how many whole commands have come, and what is wrong already."""
        return so_far(self.text)


@dataclass(frozen=True)
class ModelAnswer:
    """The model's answer once it is whole, with its tokens and what they cost."""

    text: str
    usage: TokenUsage | None = None
    """Of all that was needed for it; None for one that is not valid."""

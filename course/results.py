"""What the judge says of a step: plain data, in sentences that can be translated."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from launcher.wire import Sentence

MOST_BYTES = 1 << 22
"""Longest line in which a judge hears or says something."""


class State(str, Enum):
    """How far a step or a check is."""

    NOT_YET = "not yet"
    """Not judged so far, or being judged."""
    PASSED = "passed"
    FAILED = "failed"
    UNJUDGED = "could not be judged"
    """The fault is not the learner's: no supervisor, a type that is not installed."""
    WAITS = "waits"
    """A step that it needs has not passed."""


@dataclass(frozen=True)
class CheckResult:
    """One check of a step."""

    state: State
    what: Sentence
    """What is expected."""
    seen: Sentence = ""
    """What was seen instead; empty if it passed."""
    look: Sentence = ""
    """Where to look, for the learner."""
    hint: Sentence = ""
    """What the lesson itself says of that, which may be half of the answer."""


@dataclass(frozen=True)
class StepResult:
    """One step of a lesson."""

    id: str
    state: State
    points: int
    """How many it is worth."""
    checks: tuple[CheckResult, ...] = ()
    """As many as the step has, in its order; one more if its node is not at work."""
    reason: Sentence = ""
    """Why it waits or could not be judged."""

    @property
    def earned(self) -> int:
        """The points for it: all or none."""
        return self.points if self.state is State.PASSED else 0

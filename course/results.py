"""What the judge says of a step: plain data, in sentences that can be translated."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from launcher.profile.steps.expressions import Drawn


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
    what: str
    """What is expected, in a sentence of `text.sentences.say`, as are the next two."""
    seen: str = ""
    """What was seen instead; empty if it passed."""
    look: str = ""
    """Where to look, for the learner."""
    hint: str = ""
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
    reason: str = ""
    """Why it waits or could not be judged."""

    @property
    def earned(self) -> int:
        """The points for it: all or none."""
        return self.points if self.state is State.PASSED else 0


@dataclass(frozen=True)
class LessonResult:
    """All steps of a lesson, judged once."""

    seed: int
    values: Mapping[str, Drawn]
    steps: tuple[StepResult, ...]

    @property
    def passed(self) -> bool:
        return all(step.state is State.PASSED for step in self.steps)

"""What the judge says of a step: plain data, in sentences that can be translated, and its form between processes.

A judge's process and whoever shows what it says exchange lines of JSON. To the judge: `start`, once; then `judge`,
as often as wished, and `quit`. From it: `values`, once it is at work, `step` for whatever changes, and `end`, the
last one.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Any

from text.packing import pack_text, unpack_text

if TYPE_CHECKING:
    from collections.abc import Mapping

    from launcher.profile.steps.expressions import Drawn


MOST_BYTES = 1 << 22
"""Longest line in either direction."""


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


def pack_step(step: StepResult) -> dict[str, Any]:
    """Return the result of a step as JSON."""
    return {
        "id": step.id,
        "state": step.state.value,
        "points": step.points,
        "reason": pack_text(step.reason),
        "checks": [
            {
                "state": check.state.value,
                "what": pack_text(check.what),
                "seen": pack_text(check.seen),
                "look": pack_text(check.look),
                "hint": pack_text(check.hint),
            }
            for check in step.checks
        ],
    }


def unpack_step(fields: Mapping[str, Any]) -> StepResult:
    """Return the result that `pack_step` was given."""
    checks = tuple(
        CheckResult(State(check["state"]), *(unpack_text(check[key]) for key in ("what", "seen", "look", "hint")))
        for check in fields["checks"]
    )
    return StepResult(fields["id"], State(fields["state"]), fields["points"], checks, unpack_text(fields["reason"]))

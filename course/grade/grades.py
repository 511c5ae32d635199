"""What came of grading a folder: plain data, in sentences that can be translated."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from enum import Enum
from pathlib import Path

from course.lessons.lesson import LessonFolder
from course.results import State, StepResult
from launcher.profile.steps.expressions import Drawn
from launcher.profile.steps.model import StepDocument
from text.sentences import say


class GradeState(str, Enum):
    """What is known of a folder."""

    PASSED = "passed"
    FAILED = "failed"
    UNGRADED = "could not be graded"
    """At least one step could not be judged."""


@dataclass(frozen=True)
class StepGrade:
    """One step of a lesson, as graded."""

    step: StepDocument
    result: StepResult
    seconds: float = 0.0
    """How long it took to judge."""

    @property
    def message(self) -> str:
        """Why it has not passed, in a sentence; empty if it has."""
        if self.result.state is State.PASSED:
            return ""
        check = next((one for one in self.result.checks if one.state not in (State.PASSED, State.NOT_YET)), None)
        if check is None:
            return self.result.reason or say("it could not be judged")
        return say("{what}: {seen}", what=check.what, seen=check.seen or check.state.value)

    @property
    def look(self) -> str:
        """Where the learner should look; empty if it has passed, or nothing can be said."""
        checks = (one for one in self.result.checks if one.state is State.FAILED)
        return next((check.hint or check.look for check in checks), "")


@dataclass(frozen=True)
class Grade:
    """One folder, graded."""

    lesson: LessonFolder
    student: str
    """What it is called in tables: unique among all that are graded together."""
    folder: Path
    steps: tuple[StepGrade, ...]
    """All of them, in the lesson's order."""
    began: datetime
    seconds: float = 0.0
    seed: int = 0
    """What its values were drawn from; 0 if it was not run."""
    values: Mapping[str, Drawn] = field(default_factory=dict)
    reason: str = ""
    """Why it could not be graded to the end; empty if it was."""
    notes: tuple[str, ...] = ()
    """What else its teacher should know, in sentences."""
    bag: Path | None = None
    """The recording, if one was to be kept."""

    @property
    def points(self) -> int:
        return sum(step.result.earned for step in self.steps)

    @property
    def max_points(self) -> int:
        return sum(step.result.points for step in self.steps)

    @property
    def state(self) -> GradeState:
        states = {step.result.state for step in self.steps}
        if self.reason or states & {State.UNJUDGED, State.NOT_YET}:
            return GradeState.UNGRADED
        return GradeState.PASSED if states <= {State.PASSED} else GradeState.FAILED


def filled_up(lesson: LessonFolder, judged: Iterable[StepGrade], state: State, reason: str) -> tuple[StepGrade, ...]:
    """Return a grade for every step: those that were judged, and this one for all others."""
    by_id = {one.step.id: one for one in judged}
    return tuple(
        by_id.get(step.id) or StepGrade(step, StepResult(step.id, state, step.points, (), reason))
        for step in lesson.steps
    )

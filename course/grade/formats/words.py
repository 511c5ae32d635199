"""What the formats say of a step, in the language of the screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import localized, pick
from text.plain import plain

if TYPE_CHECKING:
    from course.grade.grades import Grade, StepGrade


def title(step: StepGrade) -> str:
    """Return the title of a step, its id if it has none."""
    return plain(pick(step.step.title) or step.step.id)


def message(step: StepGrade) -> str:
    """Return why a step has not passed; empty if it has."""
    return plain(localized(step.message))


def look(step: StepGrade) -> str:
    """Return where the learner should look; empty if nothing can be said."""
    return plain(localized(step.look))


def output(step: StepGrade) -> str:
    """Return both, a line each; empty if it has passed."""
    return "\n".join(filter(None, (message(step), look(step))))


def remarks(grade: Grade) -> list[str]:
    """Return why a folder could not be graded, and what else its teacher should know."""
    return [plain(localized(words)) for words in (grade.reason, *grade.notes) if words]

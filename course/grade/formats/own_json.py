"""Deck's own JSON: everything that is known of each folder."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from course.grade.formats.words import look, message, remarks, title
from text.i18n import localized
from text.output import json_text
from text.plain import plain

if TYPE_CHECKING:
    from collections.abc import Sequence

    from course.grade.grades import Grade, StepGrade

SCHEMA = "deck/grade/v1"


def written(grades: Sequence[Grade]) -> str:
    """Return the grades as JSON."""
    lesson = grades[0].lesson
    document = {
        "schema": SCHEMA,
        "lesson": lesson.name,
        "max_points": lesson.points,
        "grades": [_grade(grade) for grade in grades],
    }
    return json_text(document, indent=2)


def _grade(grade: Grade) -> dict[str, Any]:
    return {
        "student": grade.student,
        "folder": str(grade.folder),
        "state": grade.state.value,
        "points": grade.points,
        "max_points": grade.max_points,
        "seed": grade.seed,
        "values": dict(grade.values),
        "began": grade.began.isoformat(timespec="seconds"),
        "seconds": round(grade.seconds, 2),
        "notes": remarks(grade),
        "bag": None if grade.bag is None else str(grade.bag),
        "steps": [_step(step) for step in grade.steps],
    }


def _step(step: StepGrade) -> dict[str, Any]:
    return {
        "id": step.step.id,
        "title": title(step),
        "state": step.result.state.value,
        "points": step.result.earned,
        "max_points": step.result.points,
        "seconds": round(step.seconds, 2),
        "message": message(step),
        "look": look(step),
        "checks": [
            {
                "state": check.state.value,
                "what": plain(localized(check.what)),
                "seen": plain(localized(check.seen)),
                "look": plain(localized(check.hint or check.look)),
            }
            for check in step.result.checks
        ],
    }

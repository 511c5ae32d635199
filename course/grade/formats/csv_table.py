"""A table for a spreadsheet: a row for each folder, a column for each step (RFC 4180)."""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING

from course.grade.formats.words import message, remarks

if TYPE_CHECKING:
    from collections.abc import Sequence

    from course.grade.grades import Grade

BEGINS_FORMULA = ("=", "+", "-", "@", "\t")


def written(grades: Sequence[Grade]) -> str:
    """Return the table; its lines end as the RFC has it."""
    steps = [step.id for step in grades[0].lesson.steps]
    out = io.StringIO()
    writer = csv.writer(out)
    writer.writerow(["student", "lesson", "state", "points", "max_points", *steps, "seconds", "seed", "message"])
    for grade in grades:
        said = [f"{one.step.id}: {words}" for one in grade.steps if (words := message(one))]
        writer.writerow(
            [
                _harmless(grade.student),
                grade.lesson.name,
                grade.state.value,
                grade.points,
                grade.max_points,
                *(step.result.earned for step in grade.steps),
                f"{grade.seconds:.1f}",
                grade.seed,
                _harmless("; ".join((*remarks(grade), *said))),
            ]
        )
    return out.getvalue()


def _harmless(text: str) -> str:
    """Keep a spreadsheet from taking what a learner wrote for a formula."""
    return f"'{text}" if text.startswith(BEGINS_FORMULA) else text

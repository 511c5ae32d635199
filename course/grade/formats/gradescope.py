"""Gradescope's results.json, of one submission.

By https://gradescope-autograders.readthedocs.io/en/latest/specs/ (Output format).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from course.grade.formats.words import output, remarks, title
from course.results import State
from text.output import json_text

if TYPE_CHECKING:
    from course.grade.grades import Grade, StepGrade


def written(grade: Grade) -> str:
    """Return the document."""
    document = {
        "score": float(grade.points),
        "execution_time": round(grade.seconds, 2),
        "output": "\n".join(remarks(grade)),
        "output_format": "text",
        "test_output_format": "text",
        "test_name_format": "text",
        "visibility": "visible",
        # What stands there is for the teacher.
        "stdout_visibility": "hidden",
        "extra_data": {"lesson": grade.lesson.name, "seed": grade.seed},
        "tests": [_test(number, step) for number, step in enumerate(grade.steps, 1)],
    }
    return json_text(document, indent=2)


def _test(number: int, step: StepGrade) -> dict[str, Any]:
    return {
        "score": float(step.result.earned),
        "max_score": float(step.result.points),
        "status": "passed" if step.result.state is State.PASSED else "failed",
        "name": title(step),
        "number": str(number),
        "output": output(step),
        "visibility": "visible",
        "extra_data": {"step": step.step.id, "state": step.result.state.value},
    }

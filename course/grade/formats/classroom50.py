"""The result.json of Classroom 50, of one submission: `classroom50/result/v1`.

By https://github.com/foundation50/classroom50/blob/main/schemas/result-v1.schema.json and the page
"Advanced Autograding" of its wiki: whose submission it is comes from the environment that its
runner sets; the runner itself puts the instant of the submission in the place of `datetime`.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime, timezone
from typing import TYPE_CHECKING, Any

from course.grade.formats.words import output, title
from course.results import State
from launcher.errors import UsageError
from text.output import json_text
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Mapping

    from course.grade.grades import Grade, StepGrade

SCHEMA = "classroom50/result/v1"
REQUIRED = ("CLASSROOM", "ASSIGNMENT", "SUBMISSION_TAG", "COMMIT_URL", "RELEASE_URL")
"""Variables without which no submission can be named; there has to be an owner, too."""
TAG_BEGINS = "submit/"


@dataclass(frozen=True)
class Assignment:
    """Whose submission of what is graded."""

    classroom: str
    assignment: str
    assignment_type: str
    owner: str
    submission: str
    commit: str
    release: str
    review: str

    @classmethod
    def from_environment(cls, environ: Mapping[str, str]) -> Assignment:
        """Read what the runner of Classroom 50 has set.

        Raises:
            UsageError: if something is missing, as outside of that runner.
        """
        owner = environ.get("OWNER") or environ.get("USERNAME") or ""
        missing = [name for name in REQUIRED if not environ.get(name)]
        missing += [] if owner else ["OWNER"]
        if missing:
            raise UsageError(
                say(
                    "--format classroom50: the runner of Classroom 50 sets {names}; set them to try it elsewhere",
                    names=", ".join(missing),
                )
            )
        if not environ["SUBMISSION_TAG"].startswith(TAG_BEGINS):
            raise UsageError(
                say(
                    "SUBMISSION_TAG: expected {begin}..., found {found!r}",
                    begin=TAG_BEGINS,
                    found=environ["SUBMISSION_TAG"],
                )
            )
        return cls(
            classroom=environ["CLASSROOM"],
            assignment=environ["ASSIGNMENT"],
            assignment_type=environ.get("ASSIGNMENT_TYPE") or "individual",
            owner=owner,
            submission=environ["SUBMISSION_TAG"],
            commit=environ["COMMIT_URL"],
            release=environ["RELEASE_URL"],
            review=environ.get("REVIEW_URL") or environ["COMMIT_URL"],
        )


def written(grade: Grade, assignment: Assignment) -> str:
    """Return the document."""
    document = {
        "schema": SCHEMA,
        **vars(assignment),
        "datetime": _instant(grade.began),
        "graded_at": _instant(datetime.now(timezone.utc)),
        "score": grade.points,
        "max-score": grade.max_points,
        "tests": [_test(step) for step in grade.steps],
    }
    return json_text(document, indent=2)


def _instant(when: datetime) -> str:
    return when.astimezone(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")


def _test(step: StepGrade) -> dict[str, Any]:
    return {
        "test-name": f"{step.step.id}: {title(step)}",
        "passed": step.result.state is State.PASSED,
        "score": step.result.earned,
        "max-score": step.result.points,
        "output": output(step),
    }

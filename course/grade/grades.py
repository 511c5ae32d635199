"""What came of grading a folder, in sentences that can be translated, and how other programs are told.

They are told by Deck's own JSON, JUnit XML, or the result.json of Classroom 50.

JUnit is by the schema of the JUnit task of Ant, which CI servers read:
https://github.com/windyroad/JUnit-Schema/blob/master/JUnit.xsd

Classroom 50 is by https://github.com/foundation50/classroom50/blob/main/schemas/result-v1.schema.json and the page
"Advanced Autograding" of its wiki: whose submission it is comes from the environment that its runner sets; the runner
itself puts the instant of the submission in the place of `datetime`.
"""

from __future__ import annotations

import os
import socket
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime, timezone
from enum import Enum
from pathlib import Path
from typing import Any

from course.lessons.lesson import LessonFolder
from course.results import State, StepResult
from launcher.errors import UsageError
from launcher.profile.steps.expressions import Drawn
from launcher.profile.steps.model import StepDocument
from text.i18n import localized, pick
from text.output import json_text
from text.plain import plain
from text.sentences import say

CLASSROOM50 = "classroom50"
FORMATS = ("json", "junit", CLASSROOM50)
_REQUIRED = ("CLASSROOM", "ASSIGNMENT", "SUBMISSION_TAG", "COMMIT_URL", "RELEASE_URL")
"""Variables without which Classroom 50 can name no submission; there has to be an owner, too."""
_TAG_BEGINS = "submit/"


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
    def title(self) -> str:
        """Its title, as a person reads it; its id if it has none."""
        return plain(pick(self.step.title) or self.step.id)

    @property
    def message(self) -> str:
        """Why it has not passed, as a person reads it; empty if it has."""
        if self.result.state is State.PASSED:
            return ""
        check = next((one for one in self.result.checks if one.state not in (State.PASSED, State.NOT_YET)), None)
        if check is None:
            return plain(localized(self.result.reason or say("it could not be judged")))
        return plain(localized(say("{what}: {seen}", what=check.what, seen=check.seen or check.state.value)))

    @property
    def look(self) -> str:
        """Where the learner should look; empty if it has passed, or nothing can be said."""
        failed = (one for one in self.result.checks if one.state is State.FAILED)
        return next((plain(localized(check.hint or check.look)) for check in failed), "")


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
    def remarks(self) -> list[str]:
        """Why it could not be graded, and what else its teacher should know, as a person reads it."""
        return [plain(localized(words)) for words in (self.reason, *self.notes) if words]

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


def writer_of(name: str, count: int, environ: Mapping[str, str] = os.environ) -> Callable[[Sequence[Grade]], str]:
    """Return what writes this format.

    Raises:
        UsageError: if it is not for so many folders, or does not know whose submission it is.
    """
    if name != CLASSROOM50:
        return _json if name == "json" else _junit
    if count != 1:
        raise UsageError(say("--format {name} is for one folder, and there are {n}", name=name, n=count))
    submission = _submission(environ)
    return lambda grades: _classroom50(grades[0], submission)


def _json(grades: Sequence[Grade]) -> str:
    lesson = grades[0].lesson
    document = {
        "schema": "deck/grade/v1",
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
        "notes": grade.remarks,
        "bag": None if grade.bag is None else str(grade.bag),
        "steps": [_step(step) for step in grade.steps],
    }


def _step(step: StepGrade) -> dict[str, Any]:
    return {
        "id": step.step.id,
        "title": step.title,
        "state": step.result.state.value,
        "points": step.result.earned,
        "max_points": step.result.points,
        "seconds": round(step.seconds, 2),
        "message": step.message,
        "look": step.look,
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


def _junit(grades: Sequence[Grade]) -> str:
    """Return the document; an `error` is what is not the learner's fault, such as a dead judge."""
    root = ET.Element("testsuites")
    root.extend(_suite(number, grade) for number, grade in enumerate(grades))
    ET.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{ET.tostring(root, encoding="unicode")}\n'


def _suite(number: int, grade: Grade) -> ET.Element:
    states = [step.result.state for step in grade.steps]
    suite = ET.Element(
        "testsuite",
        name=_token(grade.student),
        package=grade.lesson.name,
        id=str(number),
        # Without a time zone, as the schema has it.
        timestamp=grade.began.strftime("%Y-%m-%dT%H:%M:%S"),
        hostname=_token(socket.gethostname()) or "localhost",
        tests=str(len(states)),
        failures=str(states.count(State.FAILED)),
        errors=str(states.count(State.UNJUDGED)),
        skipped=str(states.count(State.WAITS)),
        time=f"{grade.seconds:.3f}",
    )
    properties = ET.SubElement(suite, "properties")
    for name in ("folder", "points", "max_points", "seed"):
        ET.SubElement(properties, "property", name=name, value=plain(str(getattr(grade, name))))
    suite.extend(_case(grade, step) for step in grade.steps)
    ET.SubElement(suite, "system-out").text = "\n".join(grade.remarks)
    ET.SubElement(suite, "system-err").text = "" if grade.state is not GradeState.UNGRADED else grade.state.value
    return suite


def _case(grade: Grade, step: StepGrade) -> ET.Element:
    name, kind = _token(f"{step.step.id}: {step.title}"), f"{grade.lesson.name}.{step.step.id}"
    case = ET.Element("testcase", name=name, classname=kind, time=f"{step.seconds:.3f}")
    state = step.result.state
    if state is State.WAITS:
        ET.SubElement(case, "skipped")
    elif state is not State.PASSED:
        kind = "failure" if state is State.FAILED else "error"
        ET.SubElement(case, kind, type=state.value, message=step.message).text = step.look
    return case


def _token(text: str) -> str:
    """Return it without the white space that an xs:token has not: at its ends, or doubled."""
    return " ".join(plain(text).split())


def _submission(environ: Mapping[str, str]) -> dict[str, str]:
    """Read from what the runner of Classroom 50 has set whose submission it is.

    Raises:
        UsageError: if something is missing, as outside of that runner.
    """
    owner = environ.get("OWNER") or environ.get("USERNAME") or ""
    missing = [name for name in _REQUIRED if not environ.get(name)]
    missing += [] if owner else ["OWNER"]
    if missing:
        raise UsageError(
            say(
                "--format classroom50: the runner of Classroom 50 sets {names}; set them to try it elsewhere",
                names=", ".join(missing),
            )
        )
    tag = environ["SUBMISSION_TAG"]
    if not tag.startswith(_TAG_BEGINS):
        raise UsageError(say("SUBMISSION_TAG: expected {begin}..., found {found!r}", begin=_TAG_BEGINS, found=tag))
    return {
        "classroom": environ["CLASSROOM"],
        "assignment": environ["ASSIGNMENT"],
        "assignment_type": environ.get("ASSIGNMENT_TYPE") or "individual",
        "owner": owner,
        "submission": tag,
        "commit": environ["COMMIT_URL"],
        "release": environ["RELEASE_URL"],
        "review": environ.get("REVIEW_URL") or environ["COMMIT_URL"],
    }


def _classroom50(grade: Grade, submission: dict[str, str]) -> str:
    tests = [
        {
            "test-name": f"{step.step.id}: {step.title}",
            "passed": step.result.state is State.PASSED,
            "score": step.result.earned,
            "max-score": step.result.points,
            "output": "\n".join(filter(None, (step.message, step.look))),
        }
        for step in grade.steps
    ]
    document = {
        "schema": "classroom50/result/v1",
        **submission,
        "datetime": _utc(grade.began),
        "graded_at": _utc(datetime.now(timezone.utc)),
        "score": grade.points,
        "max-score": grade.max_points,
        "tests": tests,
    }
    return json_text(document, indent=2)


def _utc(when: datetime) -> str:
    return when.astimezone(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")

"""Grades for other programs: Deck's own JSON, JUnit XML, and the result.json of Classroom 50.

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
from collections.abc import Callable, Mapping, Sequence
from datetime import datetime, timezone
from typing import Any

from course.grade.grades import Grade, GradeState, StepGrade
from course.results import State
from launcher.errors import UsageError
from text.i18n import localized, pick
from text.output import json_text
from text.plain import plain
from text.sentences import say

CLASSROOM50 = "classroom50"
FORMATS = ("json", "junit", CLASSROOM50)
_REQUIRED = ("CLASSROOM", "ASSIGNMENT", "SUBMISSION_TAG", "COMMIT_URL", "RELEASE_URL")
"""Variables without which Classroom 50 can name no submission; there has to be an owner, too."""
_TAG_BEGINS = "submit/"


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


def title(step: StepGrade) -> str:
    return plain(pick(step.step.title) or step.step.id)


def message(step: StepGrade) -> str:
    return plain(localized(step.message))


def look(step: StepGrade) -> str:
    return plain(localized(step.look))


def remarks(grade: Grade) -> list[str]:
    """Return why a folder could not be graded, and what else its teacher should know."""
    return [plain(localized(words)) for words in (grade.reason, *grade.notes) if words]


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
    ET.SubElement(suite, "system-out").text = "\n".join(remarks(grade))
    ET.SubElement(suite, "system-err").text = "" if grade.state is not GradeState.UNGRADED else grade.state.value
    return suite


def _case(grade: Grade, step: StepGrade) -> ET.Element:
    name, kind = _token(f"{step.step.id}: {title(step)}"), f"{grade.lesson.name}.{step.step.id}"
    case = ET.Element("testcase", name=name, classname=kind, time=f"{step.seconds:.3f}")
    state = step.result.state
    if state is State.WAITS:
        ET.SubElement(case, "skipped")
    elif state is not State.PASSED:
        kind = "failure" if state is State.FAILED else "error"
        ET.SubElement(case, kind, type=state.value, message=message(step)).text = look(step)
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
            "test-name": f"{step.step.id}: {title(step)}",
            "passed": step.result.state is State.PASSED,
            "score": step.result.earned,
            "max-score": step.result.points,
            "output": "\n".join(filter(None, (message(step), look(step)))),
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

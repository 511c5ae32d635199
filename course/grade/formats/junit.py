"""JUnit XML: a suite for each folder, a case for each step.

By the schema of the JUnit task of Ant, which CI servers read:
https://github.com/windyroad/JUnit-Schema/blob/master/JUnit.xsd
"""

from __future__ import annotations

import socket
import xml.etree.ElementTree as ET
from typing import TYPE_CHECKING

from course.grade.formats.words import look, message, remarks, title
from course.grade.grades import GradeState
from course.results import State
from text.plain import plain

if TYPE_CHECKING:
    from collections.abc import Sequence

    from course.grade.grades import Grade, StepGrade


def written(grades: Sequence[Grade]) -> str:
    """Return the document; an `error` is what is not the learner's fault, such as a dead judge."""
    root = ET.Element("testsuites")
    for number, grade in enumerate(grades):
        root.append(_suite(number, grade))
    ET.indent(root)
    text = ET.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n'


def _suite(number: int, grade: Grade) -> ET.Element:
    states = [step.result.state for step in grade.steps]
    suite = ET.Element(
        "testsuite",
        {
            "name": _token(grade.student),
            "package": grade.lesson.name,
            "id": str(number),
            # Without a time zone, as the schema has it.
            "timestamp": grade.began.strftime("%Y-%m-%dT%H:%M:%S"),
            "hostname": _token(socket.gethostname()) or "localhost",
            "tests": str(len(states)),
            "failures": str(states.count(State.FAILED)),
            "errors": str(states.count(State.UNJUDGED)),
            "skipped": str(states.count(State.WAITS)),
            "time": f"{grade.seconds:.3f}",
        },
    )
    properties = ET.SubElement(suite, "properties")
    for name, value in (
        ("folder", str(grade.folder)),
        ("points", str(grade.points)),
        ("max_points", str(grade.max_points)),
        ("seed", str(grade.seed)),
    ):
        ET.SubElement(properties, "property", {"name": name, "value": plain(value)})
    suite.extend(_case(grade, step) for step in grade.steps)
    ET.SubElement(suite, "system-out").text = "\n".join(remarks(grade))
    ET.SubElement(suite, "system-err").text = "" if grade.state is not GradeState.UNGRADED else grade.state.value
    return suite


def _case(grade: Grade, step: StepGrade) -> ET.Element:
    case = ET.Element(
        "testcase",
        {
            "name": _token(f"{step.step.id}: {title(step)}"),
            "classname": f"{grade.lesson.name}.{step.step.id}",
            "time": f"{step.seconds:.3f}",
        },
    )
    state = step.result.state
    if state is State.WAITS:
        ET.SubElement(case, "skipped")
    elif state is not State.PASSED:
        kind = "failure" if state is State.FAILED else "error"
        said = ET.SubElement(case, kind, {"type": state.value, "message": message(step)})
        said.text = look(step)
    return case


def _token(text: str) -> str:
    """Return it without the white space that an xs:token has not: at its ends, or doubled."""
    return " ".join(plain(text).split())

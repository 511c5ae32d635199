"""Each format by its published description, also with what a hostile learner writes into it."""

from __future__ import annotations

import csv
import io
import json
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from course.grade.defaults import FORMATS
from course.grade.formats.choice import writer_of
from course.results import State
from launcher.errors import UsageError
from tests.unit.course.grade.made import HOSTILE, STATES, grade
from text.i18n import set_language

CLASSROOM = {
    "CLASSROOM": "robots",
    "ASSIGNMENT": "sonar",
    "ASSIGNMENT_TYPE": "group",
    "OWNER": "alice",
    "SUBMISSION_TAG": "submit/2026-06-01T14-32-05Z-a1b2c3d",
    "COMMIT_URL": "https://github.com/o/r/commit/1",
    "RELEASE_URL": "https://github.com/o/r/releases/tag/1",
}


@pytest.fixture(autouse=True)
def _english() -> Iterator[None]:
    yield
    set_language("en")


def written(name: str, *grades: Any, environ: dict[str, str] | None = None) -> str:
    return writer_of(name, len(grades), environ if environ is not None else CLASSROOM)(grades)


# Gradescope: https://gradescope-autograders.readthedocs.io/en/latest/specs/

VISIBILITIES = ("hidden", "after_due_date", "after_published", "visible")
TEXT_FORMATS = ("text", "html", "simple_format", "md", "ansi")


def check_gradescope(document: dict[str, Any]) -> None:
    """Check what the page says of each field, and that there is no other."""
    kinds: dict[str, Any] = {
        "score": float,
        "execution_time": float,
        "output": str,
        "output_format": TEXT_FORMATS,
        "test_output_format": TEXT_FORMATS,
        "test_name_format": TEXT_FORMATS,
        "visibility": VISIBILITIES,
        "stdout_visibility": VISIBILITIES,
        "extra_data": dict,
        "tests": list,
    }
    check_fields(document, kinds)
    for test in document["tests"]:
        kinds = {
            "score": float,
            "max_score": float,
            "status": ("passed", "failed"),
            "name": str,
            "number": str,
            "output": str,
            "visibility": VISIBILITIES,
            "extra_data": dict,
        }
        check_fields(test, kinds)
        assert 0 <= test["score"] <= test["max_score"]


def check_fields(document: dict[str, Any], kinds: dict[str, Any]) -> None:
    assert set(document) <= set(kinds)
    for name, value in document.items():
        kind = kinds[name]
        assert value in kind if isinstance(kind, tuple) else type(value) is kind, name


def test_gradescope() -> None:
    document = json.loads(written("gradescope", grade()))
    check_gradescope(document)
    assert document["score"] == 6
    assert document["execution_time"] == 9.88
    tests = document["tests"]
    assert [test["status"] for test in tests] == ["passed", "failed", "failed", "passed", "passed"]
    assert [test["max_score"] for test in tests] == [2, 2, 2, 3, 1]
    assert tests[1]["output"] == "/sensor comes: found it is 7\nLook."
    assert tests[2]["output"] == "waits for: topic"


# Classroom 50: https://github.com/foundation50/classroom50, schemas/result-v1.schema.json

INSTANT = re.compile(r"\d{4}-\d{2}-\d{2}T([01]\d|2[0-3]):[0-5]\d:[0-5]\dZ")


def check_classroom50(document: dict[str, Any]) -> None:
    """Check what the schema requires, and what it says that a validator checks beyond it."""
    kinds = {
        **dict.fromkeys(("classroom", "assignment", "owner", "commit", "release", "review"), str),
        "schema": ("classroom50/result/v1",),
        "assignment_type": ("individual", "group", "team"),
        "submission": str,
        "datetime": str,
        "score": int,
        "max-score": int,
        "tests": list,
    }
    optional = {"graded_at": str}
    assert set(kinds) <= set(document)
    check_fields(document, {**kinds, **optional})
    assert all(document[name] for name in ("classroom", "assignment", "owner", "commit"))
    assert document["submission"].startswith("submit/")
    assert all(INSTANT.fullmatch(document[name]) for name in ("datetime", "graded_at"))
    for one in (document, *document["tests"]):
        assert 0 <= one["score"] <= one["max-score"]
    for test in document["tests"]:
        assert type(test["score"]) is type(test["max-score"]) is int
        assert type(test["passed"]) is bool
        assert test["test-name"]
    assert document["score"] == sum(test["score"] for test in document["tests"])


def test_classroom50() -> None:
    document = json.loads(written("classroom50", grade()))
    check_classroom50(document)
    assert document["assignment_type"] == "group"
    assert document["review"] == CLASSROOM["COMMIT_URL"]
    assert document["datetime"] == "2026-06-01T14:32:05Z"
    assert (document["score"], document["max-score"]) == (6, 10)
    assert [test["passed"] for test in document["tests"]] == [True, False, False, True, True]


@pytest.mark.parametrize("missing", ["CLASSROOM", "OWNER", "SUBMISSION_TAG"])
def test_classroom50_outside_of_its_runner(missing: str) -> None:
    environ = {name: value for name, value in CLASSROOM.items() if name != missing}
    with pytest.raises(UsageError, match=missing):
        writer_of("classroom50", 1, environ)


def test_classroom50_takes_no_other_tag() -> None:
    with pytest.raises(UsageError, match="SUBMISSION_TAG"):
        writer_of("classroom50", 1, {**CLASSROOM, "SUBMISSION_TAG": "v1"})


# JUnit: https://github.com/windyroad/JUnit-Schema/blob/master/JUnit.xsd


def check_junit(text: str) -> ET.Element:
    """Check elements, their order, and attributes by the schema."""
    root = ET.fromstring(text.encode())
    assert root.tag == "testsuites"
    assert not root.attrib
    for number, suite in enumerate(root):
        assert suite.tag == "testsuite"
        assert set(suite.attrib) == {
            *("name", "package", "id", "timestamp", "hostname", "time"),
            *("tests", "failures", "errors", "skipped"),
        }
        assert suite.get("id") == str(number)
        assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d", suite.attrib["timestamp"])
        tags = [child.tag for child in suite]
        cases = suite.findall("testcase")
        assert tags == ["properties", *["testcase"] * len(cases), "system-out", "system-err"]
        for one in suite.iterfind("properties/property"):
            assert set(one.attrib) == {"name", "value"}
        for case in cases:
            assert set(case.attrib) == {"name", "classname", "time"}
            assert len(case) <= 1
            assert all(child.tag in ("skipped", "error", "failure") for child in case)
            for child in case:
                wanted = set() if child.tag == "skipped" else {"type", "message"}
                assert set(child.attrib) == wanted
        for element in (suite, *cases):
            assert element.attrib["name"] == " ".join(element.attrib["name"].split()) != ""
            assert float(element.attrib["time"]) >= 0
        found = {tag: len(suite.findall(f"testcase/{tag}")) for tag in ("failure", "error")}
        assert suite.get("tests") == str(len(cases))
        assert (suite.get("failures"), suite.get("errors")) == (
            str(found["failure"]),
            str(found["error"]),
        )
    return root


def test_junit() -> None:
    dead = grade(*[State.UNJUDGED] * 5, student="bob", reason="the judge is dead")
    root = check_junit(written("junit", grade(), dead))
    assert [suite.get("name") for suite in root] == ["alice", "bob"]
    failure = root.find("testsuite/testcase/failure")
    assert failure is not None
    assert failure.get("message") == "/sensor comes: found it is 7"
    assert failure.text == "Look."
    assert [suite.get("skipped") for suite in root] == ["1", "0"]
    assert root[1].findtext("system-out") == "the judge is dead"


def test_csv() -> None:
    rows = list(csv.DictReader(io.StringIO(written("csv", grade(), grade(student="bob")))))
    assert [row["student"] for row in rows] == ["alice", "bob"]
    assert (rows[0]["points"], rows[0]["max_points"]) == ("6", "10")
    steps = ("topic", "rate", "values", "warning", "ends")
    assert [rows[0][step] for step in steps] == ["2", "0", "0", "3", "1"]
    assert "rate: /sensor comes: found it is 7" in rows[0]["message"]


def test_a_spreadsheet_takes_nothing_for_a_formula() -> None:
    (row,) = csv.DictReader(io.StringIO(written("csv", grade(student="=1+1", reason="-2"))))
    assert row["student"] == "'=1+1"
    assert row["message"].startswith("'-2")


def test_own_json_has_everything() -> None:
    (alice,) = json.loads(written("json", grade()))["grades"]
    assert (alice["points"], alice["max_points"], alice["state"]) == (6, 10, "failed")
    assert alice["seed"] == 7
    assert alice["steps"][1]["checks"][0]["look"] == "Look."


@pytest.mark.parametrize("name", FORMATS)
def test_hostile_words_break_no_format(name: str) -> None:
    text = written(name, grade(said=HOSTILE, reason=HOSTILE))
    assert "\x1b" not in text
    assert "\x00" not in text
    text.encode()
    checks: dict[str, Callable[[str], object]] = {
        "gradescope": lambda text: check_gradescope(json.loads(text)),
        "classroom50": lambda text: check_classroom50(json.loads(text)),
        "junit": check_junit,
        "json": json.loads,
        "csv": lambda text: list(csv.reader(io.StringIO(text), strict=True)),
    }
    checks[name](text)


@pytest.mark.parametrize("name", ["gradescope", "classroom50"])
def test_some_formats_are_of_one_folder(name: str) -> None:
    with pytest.raises(UsageError, match="one folder"):
        written(name, grade(), grade())


def test_messages_are_in_the_language_of_the_screen() -> None:
    set_language("ru")
    document = json.loads(written("gradescope", grade(*STATES)))
    assert document["tests"][1]["output"].endswith("Вот.")

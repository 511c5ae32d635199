"""Grades: what is read of a learner's folder and put back, and the formats."""

from __future__ import annotations

import errno
import json
import os
import subprocess
import sys
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest

from course.grade import limits, submission
from course.grade.grades import FORMATS, Grade, writer_of
from course.grade.grading import Terms, grade_all
from course.grade.limits import Taken, descendants, remove_tree
from course.grade.submission import Files, submissions
from course.results import State
from launcher.errors import UsageError
from tests.unit.course.grade.made import HOSTILE, LESSON, grade
from text.i18n import localized, set_language

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


def written(name: str, *grades: Grade, environ: dict[str, str] | None = None) -> str:
    return writer_of(name, len(grades), environ if environ is not None else CLASSROOM)(grades)


def test_classroom50() -> None:
    # https://github.com/foundation50/classroom50, schemas/result-v1.schema.json
    document = json.loads(written("classroom50", grade()))
    assert set(document) == {
        *("schema", "classroom", "assignment", "assignment_type", "owner", "submission", "commit"),
        *("release", "review", "datetime", "graded_at", "score", "max-score", "tests"),
    }
    assert (document["schema"], document["assignment_type"]) == ("classroom50/result/v1", "group")
    assert document["review"] == CLASSROOM["COMMIT_URL"]
    assert document["datetime"] == "2026-06-01T14:32:05Z"
    assert (document["score"], document["max-score"]) == (6, 10)
    assert [test["passed"] for test in document["tests"]] == [True, False, False, True, True]
    assert [test["score"] for test in document["tests"]] == [2, 0, 0, 3, 1]
    assert all(type(test["max-score"]) is int and test["test-name"] for test in document["tests"])


@pytest.mark.parametrize("missing", ["CLASSROOM", "OWNER", "SUBMISSION_TAG"])
def test_classroom50_outside_of_its_runner(missing: str) -> None:
    environ = {name: value for name, value in CLASSROOM.items() if name != missing}
    with pytest.raises(UsageError, match=missing):
        writer_of("classroom50", 1, environ)


def test_junit() -> None:
    # https://github.com/windyroad/JUnit-Schema/blob/master/JUnit.xsd
    dead = grade(*[State.UNJUDGED] * 5, student="bob", reason="the judge is dead")
    root = ET.fromstring(written("junit", grade(), dead).encode())
    assert [suite.get("name") for suite in root] == ["alice", "bob"]
    for number, suite in enumerate(root):
        cases = suite.findall("testcase")
        assert suite.attrib.keys() == {
            *("name", "package", "id", "timestamp", "hostname", "time"),
            *("tests", "failures", "errors", "skipped"),
        }
        assert (suite.get("id"), suite.get("tests")) == (str(number), "5")
        for name in ("failure", "error"):
            assert suite.get(f"{name}s") == str(len(suite.findall(f"testcase/{name}")))
        tags = ["properties", *["testcase"] * len(cases), "system-out", "system-err"]
        assert [child.tag for child in suite] == tags
        assert all(case.attrib.keys() == {"name", "classname", "time"} for case in cases)
    failure = root.find("testsuite/testcase/failure")
    assert failure is not None
    assert (failure.get("message"), failure.text) == ("/sensor comes: found it is 7", "Look.")
    assert [suite.get("skipped") for suite in root] == ["1", "0"]
    assert root[1].findtext("system-out") == "the judge is dead"


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
    if name == "junit":
        ET.fromstring(text.encode())
    else:
        json.loads(text)


def folder(path: Path, **files: str) -> Path:
    path.mkdir(parents=True)
    for name, text in files.items():
        (path / f"{name}.py").write_text(text)
    return path


def test_learners_of_one_name_are_told_apart(tmp_path: Path) -> None:
    chosen = [folder(tmp_path / group / "anna", mock_sonar="") for group in ("a", "b")]
    assert [one.student for one in submissions(LESSON, chosen)] == ["a/anna", "b/anna"]
    assert [one.student for one in submissions(LESSON, chosen[:1])] == ["anna"]


def test_what_is_no_folder_or_named_twice_is_refused(tmp_path: Path) -> None:
    there = folder(tmp_path / "anna")
    for wrong in ([tmp_path / "nobody"], [there, tmp_path / "x" / ".." / "anna"]):
        (tmp_path / "x").mkdir(exist_ok=True)
        with pytest.raises(UsageError):
            submissions(LESSON, wrong)


def test_links_pipes_and_what_is_not_the_learners_are_not_read(tmp_path: Path) -> None:
    place = folder(tmp_path / "anna", mine="1")
    (place / "secret").symlink_to("/etc/passwd")
    (place / "round").symlink_to(place)
    os.mkfifo(place / "pipe")
    folder(place / "__pycache__", cached="")
    folder(place / ".git", history="")
    folder(place / "parts", part="2")
    files = Files.read(place)
    assert files.contents == {Path("mine.py"): b"1", Path("parts/part.py"): b"2"}
    files.write(tmp_path / "copy")
    assert (tmp_path / "copy/parts/part.py").read_text() == "2"


def test_a_gigabyte_is_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(submission, "MOST_BYTES", 1000)
    place = folder(tmp_path / "anna", mine="x" * 400)
    Files.read(place)
    with (place / "huge").open("wb") as file:
        file.truncate(10**12)
    with pytest.raises(UsageError, match="right one"):
        Files.read(place)


DEEP = """
import os
for _ in range(3000):
    os.mkdir("f" * 200)
    os.chdir("f" * 200)
open("file", "w").write("text")
"""
"""A path longer than any call takes."""
UNLINKED = """
import os
with open("file", "wb") as file:
    file.write(bytes(3 << 20))
    file.flush()
    os.unlink("file")
    print(flush=True)
    os.read(0, 1)
"""
SHARED = """
import mmap, os
with mmap.mmap(-1, 64 << 20) as memory:
    memory.write(bytes(64 << 20))
    print(flush=True)
    os.read(0, 1)
"""


@pytest.fixture(params=[UNLINKED, SHARED], ids=["unlinked", "shared"])
def at_work(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Taken]:
    """What is seen of a process, which descends from this one."""
    command = [sys.executable, "-c", request.param]
    with subprocess.Popen(command, cwd=tmp_path, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        process.stdout.readline()
        yield Taken(os.getpid(), [tmp_path])
        process.communicate(b"\n")


def test_memory_and_files_that_have_no_name_count(at_work: Taken) -> None:
    assert at_work.disk_bytes >= 3 << 20 or at_work.memory_bytes >= 64 << 20


def test_folders_that_cannot_be_looked_into_end_it(tmp_path: Path) -> None:
    subprocess.run([sys.executable, "-c", DEEP], cwd=tmp_path, check=True)
    assert "cannot be looked into" in localized(Taken(os.getpid(), [tmp_path]).excess())
    remove_tree(tmp_path)
    assert not tmp_path.exists()


def test_closed_folders_are_removed_too(tmp_path: Path) -> None:
    for name in ("deep", "deep/closed", "deep/closed/one", "open"):
        (tmp_path / "place" / name).mkdir(parents=True, exist_ok=True)
    (tmp_path / "theirs").write_text("")
    (tmp_path / "theirs").chmod(0o400)
    (tmp_path / "place" / "link").hardlink_to(tmp_path / "theirs")
    (tmp_path / "place" / "deep" / "closed").chmod(0)
    (tmp_path / "place" / "deep").chmod(0o100)
    remove_tree(tmp_path / "place")
    assert not (tmp_path / "place").exists()
    assert (tmp_path / "theirs").stat().st_mode & 0o777 == 0o400


def test_what_others_processes_hide_keeps_nobody_from_counting(monkeypatch: pytest.MonkeyPatch) -> None:
    """As where /proc is mounted with hidepid=1: it names the processes of others, and lets nobody look at them."""
    read = psutil._pslinux.open_binary

    def hidden(path: str) -> object:
        if path.startswith("/proc/1/"):
            raise PermissionError(errno.EPERM, "hidden", path)
        return read(path)

    monkeypatch.setattr("psutil._pslinux.open_binary", hidden)
    with subprocess.Popen(["sleep", "1000"]) as process:
        assert process.pid in [each.pid for each in descendants(os.getpid())]
        process.kill()


async def test_without_a_free_domain_nothing_is_graded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("course.proof.trial.LAST_SAFE_DOMAIN", 0)
    chosen = submissions(LESSON, [folder(tmp_path / "anna")])
    with pytest.raises(UsageError, match="no ROS domain is free"):
        await anext(grade_all(Terms(LESSON), chosen))


def test_many_files_end_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "FILES", 5)
    for number in range(7):
        (tmp_path / str(number)).touch()
    assert "more than 5 files" in localized(Taken(os.getpid(), [tmp_path]).excess())

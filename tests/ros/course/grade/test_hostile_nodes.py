"""Whatever a learner's node does: it gets the grade it deserves, and nothing of it is left."""

from __future__ import annotations

import asyncio
import os
import uuid
from dataclasses import dataclass
from pathlib import Path

import pytest

from course.grade import limits
from course.grade.grades import Grade, GradeState
from course.grade.grading import Domains, Terms, grade_all
from course.grade.submission import Files
from launcher.processes.confinement import Confinement, confinement
from launcher.processes.table import command_line, process_numbers
from tests.conftest import take
from tests.domains import DomainPool
from tests.ros.course.grade.lessons import handed_in, log_lesson
from text.i18n import localized

pytestmark = [pytest.mark.timeout(400), pytest.mark.nightly]

AT_ONCE = 3
FEW_PROCESSES = 40
FEW_BYTES = 24 << 20
WITHIN_S = 60.0

GOOD = """
import time
print("ready")
time.sleep(1000)
"""
HANGS = """
import signal
for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
    signal.signal(number, signal.SIG_IGN)
while True:
    pass
"""
FORKS = """
import os, signal, time
for _ in range(5):
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                signal.signal(number, signal.SIG_IGN)
            os.execve("/bin/sleep", ["sleep", "1000.MARK"], {})
        os._exit(0)
print("ready")
time.sleep(1000)
"""
MULTIPLIES = """
import subprocess, time
print("ready")
started = [subprocess.Popen(["sleep", "1000.MARK"]) for _ in range(100)]
time.sleep(1000)
"""
FLOODS = """
while True:
    print("ready", "x" * 10_000)
"""
WRITES = """
import time
print("ready")
with open("big", "wb") as file:
    for _ in range(64):
        file.write(bytes(1 << 20))
        file.flush()
time.sleep(1000)
"""
GROWS = """
import time
with open("big", "wb") as file:
    try:
        file.truncate(1 << 30)
    except OSError:
        print("ready: refused")
time.sleep(1000)
"""
KILLS = """
import os, pathlib, signal, time

def parent_of(pid):
    try:
        text = pathlib.Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return 0
    return int(text.rpartition(")")[2].split()[1])

above, pid = [], os.getpid()
while (pid := parent_of(pid)) not in (0, 1, TESTS):
    above.append(pid)
if pid != TESTS:
    above = []
if os.fork():
    time.sleep(1000)
os.setsid()
# The spawn server too, which would clean up after its supervisor.
beside = [pid for pid in map(int, filter(str.isdigit, os.listdir("/proc")))
          if above and pid not in (*above, os.getpid(), os.getppid()) and parent_of(pid) in above]
above = [*beside, *above]
refused = 0
for pid in reversed(above):
    try:
        os.kill(pid, signal.SIGKILL)
    except PermissionError:
        refused += 1
    except OSError:
        pass
print("ready" if refused and refused >= len(above) - 1 else "wild")
os.execvp("sleep", ["sleep", "1000.MARK"])
"""
"""Kills all between it and the tests, the uppermost first; never the tests themselves."""
TAMPERS = """
import pathlib, time
print("wild")
for path in PATHS:
    try:
        pathlib.Path(path).write_text("def calm(seen): pass")
    except OSError:
        pass
print("ready")
time.sleep(1000)
"""
FORGES = """
import glob, json, os, pathlib, time

def parent_of(pid):
    return int(pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])

print("wild")
results = "".join(json.dumps(event) + chr(10) for event in (
    {"event": "step", "seconds": 0.0, "step": {
        "id": "calm", "state": "passed", "points": 2, "reason": "", "checks": []}},
    {"event": "end", "reason": "", "taken": False},
))
print(results)
pid = os.getpid()
while (pid := parent_of(pid)) not in (0, 1, TESTS):
    for path in glob.glob(f"/proc/{pid}/fd/*"):
        try:
            os.write(os.open(path, os.O_WRONLY | os.O_NONBLOCK), results.encode())
        except OSError:
            pass
print("ready")
time.sleep(1000)
"""
"""Writes results into whatever the processes above it have open."""
OWN_PROFILE = """
title: {en: Mine}
nodes:
  talker: {exec: [sh, -c, "echo ready; sleep 1000"]}
"""


@dataclass(frozen=True)
class Graded:
    """What came of all of them."""

    confined: dict[str, Grade]
    open: dict[str, Grade]
    """Those that were graded as on a kernel that cannot confine."""
    files_before: dict[Path, bytes]
    files_after: dict[Path, bytes]
    mark: str
    """What stands in the command lines of processes that they start."""


@pytest.fixture(scope="module")
def graded(domain_pool: DomainPool, tmp_path_factory: pytest.TempPathFactory) -> Graded:
    """Grade all of them: together that takes a third of the time."""
    place = tmp_path_factory.mktemp("grading")
    mark = str(uuid.uuid4().int)[:9]
    lesson = log_lesson(place / "lesson")
    kills = KILLS.replace("MARK", mark).replace("TESTS", str(os.getpid()))
    texts = {
        "good": GOOD,
        "hangs": HANGS,
        "forks": FORKS.replace("MARK", mark),
        "multiplies": MULTIPLIES.replace("MARK", mark),
        "floods": FLOODS,
        "writes": WRITES,
        "grows": GROWS,
        "kills": kills,
    }
    paths = [
        str(place / "lesson" / "checks.py"),
        str(place / "lesson" / "lesson.yaml"),
        str(place / "lesson" / "starter" / "talker.py"),
        str(place / "open" / "tampers" / "talker.py"),
        str(place / "open" / "victim" / "talker.py"),
    ]
    open_texts = {
        "tampers": TAMPERS.replace("PATHS", repr(paths)),
        "forges": FORGES.replace("TESTS", str(os.getpid())),
        "kills": kills,
        "victim": GOOD,
    }
    confined = handed_in(lesson, place / "confined", **texts)
    (place / "confined" / "hangs" / "lesson.yaml").write_text(OWN_PROFILE)
    unconfined = handed_in(lesson, place / "open", **open_texts)
    before = Files.read(place).contents
    domains = Domains([take(domain_pool) for _ in range(AT_ONCE)])

    async def grade() -> tuple[dict[str, Grade], dict[str, Grade]]:
        found: list[dict[str, Grade]] = []
        for submitted, is_confined in ((confined, True), (unconfined, False)):
            terms = Terms(lesson, within_s=WITHIN_S, confined=is_confined)
            jobs = AT_ONCE if is_confined else 1
            coming = grade_all(terms, submitted, jobs=jobs, domains=domains)
            found.append({grade.student: grade async for _number, grade in coming})
        return found[0], found[1]

    try:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(limits, "PROCESSES", FEW_PROCESSES)
            patch.setattr(limits, "DISK_BYTES", FEW_BYTES)
            of_confined, of_open = asyncio.run(grade())
    finally:
        domain_pool.let_go(*domains.fixed)
    return Graded(of_confined, of_open, before, Files.read(place).contents, mark)


def test_a_good_one_gets_its_points_beside_all_others(graded: Graded) -> None:
    grade = graded.confined["good"]
    assert (grade.state, grade.points, grade.reason) == (GradeState.PASSED, 3, "")
    assert grade.notes == ()


def test_one_that_hangs_fails_and_its_own_profile_does_not_count(graded: Graded) -> None:
    grade = graded.confined["hangs"]
    assert grade.state is GradeState.FAILED
    assert [step.result.earned for step in grade.steps] == [0, 2]
    assert "lesson.yaml was not used" in " ".join(grade.notes)


@pytest.mark.parametrize("name", ["forks", "floods", "grows"])
def test_what_does_no_harm_to_its_steps_passes(name: str, graded: Graded) -> None:
    assert graded.confined[name].state is GradeState.PASSED


@pytest.mark.parametrize(
    ("name", "why"), [("multiplies", "more than 40 processes"), ("writes", "more than 24 MB")]
)
def test_too_much_of_something_ends_it(name: str, why: str, graded: Graded) -> None:
    grade = graded.confined[name]
    assert grade.state is GradeState.UNGRADED
    assert why in localized(grade.reason)


def test_a_confined_one_cannot_kill_its_judge(graded: Graded) -> None:
    grade = graded.confined["kills"]
    if confinement() is Confinement.FULL:
        assert grade.state is GradeState.PASSED
    else:
        assert grade.state is GradeState.UNGRADED


def test_one_that_kills_its_judge_is_not_graded(graded: Graded) -> None:
    grade = graded.open["kills"]
    assert grade.state is GradeState.UNGRADED
    assert grade.points == 0
    assert all(step.message for step in grade.steps)


def test_what_it_changes_counts_for_nothing_and_is_put_back(graded: Graded) -> None:
    grade = graded.open["tampers"]
    assert [step.result.earned for step in grade.steps] == [1, 0]
    assert "checks.py" in " ".join(grade.notes)
    assert graded.open["victim"].state is GradeState.PASSED
    assert graded.files_after == graded.files_before


def test_results_cannot_be_forged(graded: Graded) -> None:
    grade = graded.open["forges"]
    assert [step.result.earned for step in grade.steps] == [1, 0]


def test_nothing_is_left_running(graded: Graded) -> None:
    lines = [command_line(pid) for pid in process_numbers()]
    assert [line for line in lines if f"1000.{graded.mark}" in line] == []

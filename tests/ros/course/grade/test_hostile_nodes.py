"""Whatever a learner's node does: it gets the grade it deserves, and nothing of it is left."""

from __future__ import annotations

import asyncio
import uuid

import pytest

from course.grade import limits
from course.grade.grades import Grade, GradeState
from course.grade.grading import Terms, grade_all
from course.grade.walls import bubblewrap_for
from launcher.processes.table import command_line, process_numbers
from tests.conftest import take
from tests.domains import DomainPool
from tests.ros.course.grade.lessons import handed_in, log_lesson
from text.i18n import localized

pytestmark = [pytest.mark.timeout(400), pytest.mark.nightly, pytest.mark.machine("bubblewrap")]

AT_ONCE = 3
FEW_PROCESSES = 40
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
OWN_PROFILE = """
title: {en: Mine}
nodes:
  talker: {exec: [sh, -c, "echo ready; sleep 1000"]}
"""


MARK = str(uuid.uuid4().int)[:9]
"""What stands in the command lines of processes that they start."""
TEXTS = {"good": GOOD, "hangs": HANGS, "forks": FORKS, "multiplies": MULTIPLIES}


@pytest.fixture(scope="module")
def graded(domain_pool: DomainPool, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Grade]:
    place = tmp_path_factory.mktemp("grading")
    lesson = log_lesson(place / "lesson")
    texts = {name: text.replace("MARK", MARK) for name, text in TEXTS.items()}
    submitted = handed_in(lesson, place / "class", **texts)
    (place / "class" / "hangs" / "lesson.yaml").write_text(OWN_PROFILE)
    domains = [take(domain_pool) for _ in range(AT_ONCE)]

    async def grade() -> dict[str, Grade]:
        terms = Terms(lesson, within_s=WITHIN_S, bubblewrap=bubblewrap_for(lesson))
        coming = grade_all(terms, submitted, jobs=AT_ONCE, domains=domains)
        return {grade.student: grade async for _number, grade in coming}

    try:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(limits, "PROCESSES", FEW_PROCESSES)
            return asyncio.run(grade())
    finally:
        domain_pool.let_go(*domains)


def test_a_good_one_gets_its_points_beside_all_others(graded: dict[str, Grade]) -> None:
    grade = graded["good"]
    assert (grade.state, grade.points, grade.reason) == (GradeState.PASSED, 3, "")
    assert grade.notes == ()


def test_one_that_hangs_fails_and_its_own_profile_does_not_count(graded: dict[str, Grade]) -> None:
    grade = graded["hangs"]
    assert grade.state is GradeState.FAILED
    assert [step.result.earned for step in grade.steps] == [0, 2]
    assert "lesson.yaml was not used" in " ".join(grade.notes)


def test_too_many_processes_end_it_and_nothing_is_left_running(graded: dict[str, Grade]) -> None:
    assert graded["multiplies"].state is GradeState.UNGRADED
    assert "more than 40 processes" in localized(graded["multiplies"].reason)
    assert graded["forks"].state is GradeState.PASSED
    lines = [command_line(pid) for pid in process_numbers()]
    assert [line for line in lines if f"1000.{MARK}" in line] == []

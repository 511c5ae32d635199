"""Each lesson proves itself: its starter fails, its solution passes, its mistakes are caught.

The solution is graded by `deck grade` itself, confined as a learner's files are.
"""

from __future__ import annotations

import asyncio
import json
import sys
from typing import TYPE_CHECKING

import pytest

from course.lessons.catalog import SHIPPED
from course.lessons.lesson import LessonFolder, folders
from course.proof.proof import incomplete, prove, variants
from tests.conftest import take

if TYPE_CHECKING:
    from tests.domains import DomainPool

pytestmark = [pytest.mark.nightly, pytest.mark.machine("bubblewrap")]

PROVEN_AT_ONCE, GRADED_AT_ONCE = 6, 2
"""Together more than the cores of a small machine: most of the time a run waits."""
NODES_OF_MANY = 10
MISTAKES_AT_LEAST = 5
NAMES = [folder.name for folder in folders(SHIPPED)]


@pytest.fixture(scope="module")
def complaints(
    request: pytest.FixtureRequest, domain_pool: DomainPool, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, list[str]]:
    """By lesson, what does not prove what it should; all at once, which is quicker."""
    place = tmp_path_factory.mktemp("proof")
    names = [name for name in NAMES if any(f"[{name}]" in each for each in _asked_for(request))]
    chosen = [LessonFolder(SHIPPED / name) for name in names]
    domains = [take(domain_pool) for _ in range(PROVEN_AT_ONCE + GRADED_AT_ONCE)]
    try:
        with pytest.MonkeyPatch.context() as environment:
            for variable in ("DECK_RUN_DIR", "DECK_LOG_DIR", "ROS_LOG_DIR"):
                environment.setenv(variable, str(place / variable))
            found = asyncio.run(_all(chosen, domains))
    finally:
        domain_pool.let_go(*domains)
    return {name: [words for lesson, words in found if lesson == name] for name in names}


def _asked_for(request: pytest.FixtureRequest) -> list[str]:
    """Return the names of the tests of this file that are to be run."""
    return [item.name for item in request.session.items if item.path == request.path]


async def _all(chosen: list[LessonFolder], domains: list[int]) -> list[tuple[str, str]]:
    """Return lesson and complaint, of all that have one; whole robots one at a time, at the end."""
    robots = [lesson for lesson in chosen if len(lesson.profile.nodes) > NODES_OF_MANY]
    others = [lesson for lesson in chosen if lesson not in robots]
    found = await asyncio.gather(_proven(others, domains[:PROVEN_AT_ONCE]), _graded(others, domains[PROVEN_AT_ONCE:]))
    return [*found[0], *found[1], *await _proven(robots, domains[:1]), *await _graded(robots, domains[:1])]


async def _proven(chosen: list[LessonFolder], domains: list[int]) -> list[tuple[str, str]]:
    everything = [each for lesson in chosen for each in variants(lesson)]
    others = [each for each in everything if each.name != "solution"]
    return [
        (verdict.variant.lesson.name, f"{verdict.variant.name}: {verdict.complaint}")
        async for verdict in prove(others, domains)
        if verdict.complaint
    ]


async def _graded(chosen: list[LessonFolder], domains: list[int]) -> list[tuple[str, str]]:
    waiting = list(chosen)
    found: list[tuple[str, str]] = []

    async def in_domain(domain: int) -> None:
        while waiting:
            lesson = waiting.pop()
            words = await _grade(lesson, domain)
            if words:
                found.append((lesson.name, f"solution: {words}"))

    await asyncio.gather(*map(in_domain, domains))
    return found


async def _grade(lesson: LessonFolder, domain: int) -> str:
    """Return what `deck grade` has to say against a solution."""
    command = (sys.executable, "-m", "tui", "grade", lesson.name, str(lesson.solution))
    options = ("--domain", str(domain), "--format", "json", "--timeout", "400")
    grading = await asyncio.create_subprocess_exec(
        *command, *options, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE
    )
    out, errors = await grading.communicate()
    if grading.returncode == 0:
        return ""
    try:
        grade = json.loads(out)["grades"][0]
    except ValueError:
        return errors.decode()
    steps = [(step["id"], step["message"]) for step in grade["steps"] if step["message"]]
    return f"{grade['points']} points (seed {grade['seed']}): {steps}"


@pytest.mark.timeout(1800)
@pytest.mark.parametrize("name", NAMES)
def test_starter_solution_and_mistakes(name: str, complaints: dict[str, list[str]]) -> None:
    lesson = LessonFolder(SHIPPED / name)
    assert incomplete(lesson) == []
    assert len(lesson.mistakes()) >= MISTAKES_AT_LEAST
    assert complaints[name] == []

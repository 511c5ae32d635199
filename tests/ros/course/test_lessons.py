"""Each lesson proves itself: its starter fails, its solution passes, its mistakes are caught."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest

from course.lessons.catalog import SHIPPED
from course.lessons.lesson import LessonFolder, folders
from course.proof.proof import incomplete, prove, variants
from tests.conftest import take

if TYPE_CHECKING:
    from course.proof.proof import ProofVerdict, Variant
    from tests.domains import DomainPool

AT_ONCE = 8
"""More than the cores of a small machine: most of the time a run waits."""
MISTAKES_AT_LEAST = 5
NAMES = [folder.name for folder in folders(SHIPPED)]


@pytest.fixture(scope="module")
def verdicts(
    request: pytest.FixtureRequest,
    domain_pool: DomainPool,
    tmp_path_factory: pytest.TempPathFactory,
) -> list[ProofVerdict]:
    """What comes of every variant of the lessons asked for; all at once, which is quicker."""
    place = tmp_path_factory.mktemp("proof")
    names = [name for name in NAMES if any(f"[{name}]" in each for each in _asked_for(request))]
    everything = [each for name in names for each in variants(LessonFolder(SHIPPED / name))]
    domains = [take(domain_pool) for _ in range(AT_ONCE)]
    try:
        with pytest.MonkeyPatch.context() as environment:
            for variable in ("DECK_RUN_DIR", "DECK_LOG_DIR", "ROS_LOG_DIR"):
                environment.setenv(variable, str(place / variable))
            environment.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
            return asyncio.run(_all(everything, domains))
    finally:
        domain_pool.let_go(*domains)


def _asked_for(request: pytest.FixtureRequest) -> list[str]:
    """Return the names of the tests of this file that are to be run."""
    return [item.name for item in request.session.items if item.path == request.path]


async def _all(everything: list[Variant], domains: list[int]) -> list[ProofVerdict]:
    return [verdict async for verdict in prove(everything, domains)]


@pytest.mark.timeout(1800)
@pytest.mark.parametrize("name", NAMES)
def test_starter_solution_and_mistakes(name: str, verdicts: list[ProofVerdict]) -> None:
    lesson = LessonFolder(SHIPPED / name)
    assert incomplete(lesson) == []
    assert len(lesson.mistakes()) >= MISTAKES_AT_LEAST
    complaints = {
        verdict.variant.name: (verdict.complaint, verdict.result and verdict.result.seed)
        for verdict in verdicts
        if verdict.variant.lesson.name == name and verdict.complaint
    }
    assert complaints == {}

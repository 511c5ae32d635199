"""Every kind of check against a node that does some things right and others wrong."""

from __future__ import annotations

import asyncio
import shutil
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import yaml

from course.judge.evidence import MET
from course.judge.judge import Judge, judging
from course.lessons.lesson import LessonFolder
from course.results import CheckResult, State
from launcher.client.client import launch
from tests.conftest import take

if TYPE_CHECKING:
    from tests.domains import DomainPool

STUBBORN = """
import sys, time
print("ready", flush=True)
try:
    time.sleep(1000)
except KeyboardInterrupt:
    sys.exit(3)
"""
CHECKS = """
GREETING = {"severity": "info", "text": "the actor is there"}

def grows(seen):
    values = [message["data"] for _, message in seen.messages["/count"]]
    if len(values) < 3:
        return "too few"
    return None if values == sorted(values) else {"en": "it shrinks", "ru": "убывает"}

def logs(seen):
    logged = [line for _, line in seen.logged["actor"]][:1] + seen.logged["stubborn"]
    return None if (logged, seen.logs["stubborn"]) == ([GREETING], ["ready"]) else f"{logged}"

def never(seen):
    return {"en": f"drawn: {seen.values['n']}", "ru": "нет"}

def breaks(seen):
    return seen.messages["/nowhere"]

def hangs(seen):
    while True:  # Until the judge puts an end to it
        pass
"""
FLASH = """
import rclpy, time
rclpy.init()
node = rclpy.create_node("flash")
time.sleep(0.2)  # Long enough to be discovered
node.destroy_node()
rclpy.shutdown()
"""
KINDS = yaml.safe_load(Path(__file__).with_name("kinds.yaml").read_text("utf-8"))
PASSING: dict[str, dict[str, Any]] = KINDS["passing"]
FAILING, UNJUDGED = (
    {name: (row["check"], row["said"]) for name, row in KINDS[group].items()} for group in ("failing", "unjudged")
)


def all_checks() -> dict[str, dict[str, Any]]:
    """All of them by a name of their own, with as little waiting for what will not come."""
    checks = {f"pass-{name}": dict(check) for name, check in PASSING.items()}
    for kind, some in (("fail", FAILING), ("none", UNJUDGED)):
        checks |= {f"{kind}-{name}": {"within": 3, **check} for name, (check, _) in some.items()}
    return checks


@pytest.fixture(scope="module")
def results(domain_pool: DomainPool, tmp_path_factory: pytest.TempPathFactory) -> dict[str, CheckResult]:
    """What the judge says of each: all at the same time, in one session."""
    folder = tmp_path_factory.mktemp("lesson")
    shutil.copy(Path(__file__).with_name("actor.py"), folder)
    (folder / "checks.py").write_text(CHECKS, "utf-8")
    steps = [{"id": name, "checks": [check]} for name, check in all_checks().items()]
    nodes = {
        "actor": {"run": "./actor.py"},
        "stubborn": {"exec": [sys.executable, "-c", STUBBORN], "restart": "never"},
        "flash": {"exec": [sys.executable, "-c", FLASH], "restart": "never"},
        "broken": {"exec": [sys.executable, "-c", "import sys; sys.exit(4)"], "restart": "never"},
    }
    (folder / "lesson.yaml").write_text(
        yaml.safe_dump({"nodes": nodes, "values": {"n": {"between": [10, 99]}}, "steps": steps})
    )
    domain = take(domain_pool)
    try:
        with pytest.MonkeyPatch.context() as environment:
            for variable in ("DECK_RUN_DIR", "DECK_LOG_DIR", "ROS_LOG_DIR"):
                environment.setenv(variable, str(folder / variable))
            return asyncio.run(_judged(LessonFolder(folder), domain))
    finally:
        domain_pool.let_go(domain)


async def _judged(lesson: LessonFolder, domain: int) -> dict[str, CheckResult]:
    client = await launch(lesson.path / "lesson.yaml", domain=domain)
    try:
        async with judging(lesson, client, seed=1) as judge:
            judge.follow()
            await judge.settle()
            seen = await judge.evidence.until(lambda: MET if _all_heard(judge) else None, 60)
            assert seen.met, "the actor has not been heard"
            found = await asyncio.gather(*(judge.step(step) for step in lesson.steps))
            return {step.id: step.checks[0] for step in found}
    finally:
        await client.shutdown()


def _all_heard(judge: Judge) -> bool:
    """Whether the actor is at work, and what was to end has: a loaded machine takes its time."""
    topics = ("/count", "/same", "/near", "/image", "/still")
    heard = all(judge.evidence.messages(topic, 0.0) for topic in topics)
    actions = [row.name for row in judge.evidence.update.actions]
    ended = not judge.evidence.nodes["flash"].state.alive
    return heard and ended and "/drive_to" in actions


@pytest.mark.parametrize("name", PASSING)
def test_what_holds_passes(name: str, results: dict[str, CheckResult]) -> None:
    found = results[f"pass-{name}"]
    assert (found.state, found.seen) == (State.PASSED, "")


@pytest.mark.parametrize("name", FAILING)
def test_what_does_not_hold_fails_and_says_what_was_seen(name: str, results: dict[str, CheckResult]) -> None:
    found = results[f"fail-{name}"]
    assert found.state is State.FAILED
    assert FAILING[name][1] in found.seen


@pytest.mark.parametrize("name", UNJUDGED)
def test_a_fault_of_the_lesson_is_not_the_learners(name: str, results: dict[str, CheckResult]) -> None:
    found = results[f"none-{name}"]
    assert found.state is State.UNJUDGED
    assert UNJUDGED[name][1] in found.seen


def test_a_node_that_has_ended_is_where_to_look(results: dict[str, CheckResult]) -> None:
    assert "broken does not run" in results["fail-node"].look

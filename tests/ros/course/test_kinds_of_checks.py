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

FLOAT, STRING = "std_msgs/msg/Float32", "std_msgs/msg/String"
DRIVE = "deck_interfaces/action/DriveToPoint"
ADD = "example_interfaces/srv/AddTwoInts"
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
ASKED: dict[str, Any] = {"publish": "/ask", "type": STRING, "message": {"data": "a${n}"}}

PASSING: dict[str, dict[str, Any]] = {
    "node": {"node": "/actor"},
    "topic": {"topic": "/count", "type": FLOAT, "by": "/actor", "publishers": 1},
    "subscription": {"subscription": "/ask", "by": "/actor", "type": STRING},
    "rate": {"rate": "/count", "between": [9, 11], "over": 2},
    "field-between": {"field": "/near", "type": FLOAT, "path": "data", "between": [0.2, 0.4]},
    "field-equals": {"field": "/same", "type": FLOAT, "path": "data", "equals": 1, "messages": 3},
    "field-changes": {"field": "/count", "type": FLOAT, "path": "data", "changes": True},
    "qos": {"qos": "/same", "reliability": "best_effort", "durability": "volatile"},
    "service": {
        "service": "/add",
        "type": ADD,
        "request": {"a": "${n}", "b": 2},
        "response": {"sum": "${n + 2}"},
    },
    "action": {"action": "/drive_to", "type": DRIVE, "result": {"reached": True}},
    "action-cancel": {
        "action": "/drive_to",
        "type": DRIVE,
        "goal": {"x": 2.0},
        "cancel": True,
        "feedback": "distance",
    },
    "action-refused": {
        "action": "/drive_to",
        "type": DRIVE,
        "goal": {"x": -1.0},
        "accepted": False,
    },
    "publish": {
        **ASKED,
        "then": [
            {"field": "/answer", "type": STRING, "path": "data", "equals": "A${n}"},
            {"log": "actor", "matches": "asked: a${n}", "level": "warn"},
        ],
    },
    "publish-unheard": {
        "publish": "/ask_twice",
        "type": STRING,
        "then": [{"field": "/second", "type": STRING, "path": "data", "equals": "yes"}],
    },
    "publish-unheard-among-others": {
        "publish": "/among",
        "type": STRING,
        "message": {"data": "yours"},
        "then": [{"field": "/echo", "type": STRING, "path": "data", "equals": "yours"}],
    },
    "nothing": {"nothing": "/silent", "type": STRING, "for": 0.5},
    "parameter": {
        "parameter": "limit",
        "of": "/actor",
        "type": "double",
        "value": 0.5,
        "set": 0.7,
        "refuses": -1.0,
    },
    "transform": {
        "transform": {"from": "base", "to": "eye"},
        "translation": [0.3, 0, 0],
        "rotation_rpy": [0, 0, 0],
    },
    "log": {"log": "actor", "matches": "actor is there", "level": "info"},
    "image": {
        "image": "/image",
        "width": 2,
        "height": 1,
        "encoding": "bgr8",
        "changes": True,
        "rate": [8, 12],
    },
    "no-publisher": {"no_publisher": "/count", "except": "/actor"},
    "gate": {"gate": "/shut", "from": "/actor", "distance": "/near", "stop_below": 0.5, "over": 1},
    "python": {"python": "checks.py:grows", "topics": {"/count": FLOAT}},
    # It needs no topic: /rosout may forget, or be heard too late.
    "python-logged": {"python": "checks.py:logs"},
}

FAILING: dict[str, tuple[dict[str, Any], str]] = {
    "node": ({"node": "/aktor"}, "there is no node /aktor, but /actor"),
    "node-ends": ({"node": "/flash"}, "there is no node /flash"),
    "topic-name": (
        {"topic": "/cuont", "type": FLOAT},
        "nobody publishes /cuont, but /count is published",
    ),
    "topic-type": (
        {"topic": "/count", "type": STRING},
        f"/count has the type {FLOAT}, not {STRING}",
    ),
    "subscription": (
        {"subscription": "/ask", "by": "/actor", "type": FLOAT},
        "not std_msgs/msg/Float32",
    ),
    "rate": ({"rate": "/count", "between": [100, 200], "over": 1}, "/count comes "),
    "field": (
        {"field": "/near", "type": FLOAT, "path": "data", "between": [1, 2]},
        "data of /near is 0.3",
    ),
    "field-changes": (
        {"field": "/same", "type": FLOAT, "path": "data", "changes": True},
        "data of /same is always 1",
    ),
    "field-path": (
        {"field": "/near", "type": FLOAT, "path": "dato", "equals": 1},
        "did you mean data?",
    ),
    "field-type": (
        {"field": "/near", "type": STRING, "path": "data", "matches": "x"},
        f"has the type {FLOAT}",
    ),
    "qos": ({"qos": "/same", "reliability": "reliable"}, "/actor: best_effort, not reliable"),
    "service": (
        {"service": "/add", "type": ADD, "request": {"a": 1, "b": 2}, "response": {"sum": 4}},
        "answered {sum: 3}",
    ),
    "service-name": ({"service": "/ad", "type": ADD}, "there is no service /ad, but /add"),
    "action": ({"action": "/drive_to", "type": DRIVE, "goal": {"x": -1.0}}, "ended as rejected"),
    "publish": (
        {**ASKED, "then": [{"field": "/answer", "type": STRING, "path": "data", "equals": "B"}]},
        "data of /answer is A",
    ),
    "publish-deaf": (
        {"publish": "/aks", "type": STRING, "then": [{"log": "actor", "matches": "x"}]},
        "nobody subscribes to /aks, but /ask is subscribed to",
    ),
    "nothing": ({"nothing": "/count", "type": FLOAT, "for": 5}, "a message came on /count"),
    "parameter": ({"parameter": "limt", "of": "/actor"}, "declares no parameter limt, but limit"),
    "parameter-type": (
        {"parameter": "loose", "of": "/actor", "type": "double"},
        "loose is a integer, not a double",
    ),
    "parameter-refuses": ({"parameter": "loose", "of": "/actor", "refuses": -1}, "loose takes -1"),
    "transform": (
        {"transform": {"from": "base", "to": "eye"}, "translation": [0, 0, 0]},
        "0.300, 0.000, 0.000",
    ),
    "transform-frame": ({"transform": {"from": "base", "to": "aye"}}, "the frame aye, but eye"),
    "log": ({"log": "actor", "matches": "is there", "level": "warn"}, "as info, not as warn"),
    "image": ({"image": "/image", "width": 640}, "width of /image is 2"),
    "image-changes": ({"image": "/still", "changes": True}, "all pictures of /still are the same"),
    "no-publisher": ({"no_publisher": "/count"}, "/count is published by /actor"),
    "gate": (
        {"gate": "/open", "from": "/actor", "distance": "/near", "stop_below": 0.5, "over": 2},
        "/open lets 0.40 m/s through",
    ),
    "gate-road": (
        {"gate": "/shut", "from": "/gate", "distance": "/near", "stop_below": 0.5, "over": 1},
        "/shut is published by /actor",
    ),
    "python": ({"python": "checks.py:never"}, "drawn: "),
    "ends-late": ({"ends": "stubborn"}, "stubborn ends with exit code 3"),
}

UNJUDGED: dict[str, tuple[dict[str, Any], str]] = {
    "python-breaks": ({"python": "checks.py:breaks"}, "KeyError"),
    "python-hangs": ({"python": "checks.py:hangs"}, "takes longer than"),
    "publish-field": (
        {
            "publish": "/ask",
            "type": STRING,
            "message": {"dato": 1},
            "then": [{"log": "actor", "matches": "x"}],
        },
        "dato",
    ),
}


def all_checks() -> dict[str, dict[str, Any]]:
    """All of them by a name of their own, with as little waiting for what will not come."""
    checks = {f"pass-{name}": dict(check) for name, check in PASSING.items()}
    for kind, some in (("fail", FAILING), ("none", UNJUDGED)):
        checks |= {f"{kind}-{name}": {"within": 3, **check} for name, (check, _) in some.items()}
    return checks


@pytest.fixture(scope="module")
def results(
    domain_pool: DomainPool, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, CheckResult]:
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
            environment.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
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
    topics = ("/count", "/same", "/near", "/image", "/still", "/shut", "/open", "/tf_static")
    heard = all(judge.evidence.messages(topic, 0.0) for topic in topics)
    actions = [row.name for row in judge.evidence.update.actions]
    ended = not judge.evidence.nodes["flash"].state.alive
    return heard and ended and "/drive_to" in actions


@pytest.mark.parametrize("name", PASSING)
def test_what_holds_passes(name: str, results: dict[str, CheckResult]) -> None:
    found = results[f"pass-{name}"]
    assert (found.state, found.seen) == (State.PASSED, "")


@pytest.mark.parametrize("name", FAILING)
def test_what_does_not_hold_fails_and_says_what_was_seen(
    name: str, results: dict[str, CheckResult]
) -> None:
    found = results[f"fail-{name}"]
    assert found.state is State.FAILED
    assert FAILING[name][1] in found.seen


@pytest.mark.parametrize("name", UNJUDGED)
def test_a_fault_of_the_lesson_is_not_the_learners(
    name: str, results: dict[str, CheckResult]
) -> None:
    found = results[f"none-{name}"]
    assert found.state is State.UNJUDGED
    assert UNJUDGED[name][1] in found.seen


def test_a_node_that_has_ended_is_where_to_look(results: dict[str, CheckResult]) -> None:
    assert "broken does not run" in results["fail-node"].look

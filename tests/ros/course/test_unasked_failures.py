"""A node that fails by itself fails all its steps, whichever is on; one that is provoked, one."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import Any

import pytest
import yaml

from course.judge.judge import judging
from course.lessons.lesson import LessonFolder
from course.results import State, StepResult
from launcher.client.client import launch

pytestmark = pytest.mark.nightly

NODE = """\
import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Own(Node):
    def __init__(self):
        super().__init__("{name}")
        self.create_subscription(String, "/poke", self.on_poke, 10)
        self.create_timer(3.0, self.later)
        print("ready", flush=True)

    def later(self):
        {later}

    def on_poke(self, message):
        print("poked", flush=True)
        {poked}


rclpy.init()
node = Own()
{spin}
"""
QUIET = {"nothing": "/quiet", "type": "std_msgs/msg/String"}
POKE = {"publish": "/poke", "type": "std_msgs/msg/String", "message": {"data": "?"}}
PARTS = {"later": "pass", "poked": "pass", "spin": "rclpy.spin(node)"}
FAILING = {
    "early": {"later": "{}['speed']"},
    "over": {"spin": "[rclpy.spin_once(node, timeout_sec=1.0) for _ in range(3)]"},
    "works": {},
}
TOUCHY = {"touchy": {"poked": "1 / 0"}}
"""What is unlike a node that works."""


def is_ready(name: str) -> dict[str, Any]:
    return {"log": name, "matches": "ready", "within": 30}


def step(id_: str, name: str, *checks: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {"id": id_, "file": f"{name}.py", "checks": [*checks], **more}


async def judged(
    place: Path, domain: int, nodes: dict[str, dict[str, str]], steps: list[dict[str, Any]]
) -> dict[str, StepResult]:
    """Judge all steps once; return what was told of each last."""
    for name, other in nodes.items():
        text = textwrap.dedent(NODE).format(name=name, **{**PARTS, **other})
        (place / f"{name}.py").write_text(text)
    run = {name: {"run": f"./{name}.py", "restart": "on-failure"} for name in nodes}
    (place / "lesson.yaml").write_text(yaml.safe_dump({"nodes": run, "steps": steps}))
    told: dict[str, StepResult] = {}
    client = await launch(place / "lesson.yaml", domain=domain)
    try:
        async with judging(LessonFolder(place), client, seed=1) as judge:
            result = await judge.once(on_step=lambda step: told.update({step.id: step}))
    finally:
        await client.shutdown()
    assert tuple(told.values()) == result.steps
    return told


def states(of: dict[str, StepResult]) -> dict[str, str]:
    return {id_: result.state.value for id_, result in of.items()}


@pytest.mark.timeout(300)
async def test_the_same_is_said_however_long_the_steps_take(
    tmp_path: Path, ros_domain: int
) -> None:
    """With a slow first step the nodes fail before their steps begin, with a quick one in them."""
    first, second = [
        await judged(
            tmp_path,
            ros_domain,
            FAILING,
            [
                step("calm", "works", {**QUIET, "for": quiet_s}),
                step("begins", "early", is_ready("early")),
                step("lasts", "over", is_ready("over")),
                step("goes-on", "early", {"node": "/early"}, {**QUIET, "for": 2.0}),
                step("after", "works", is_ready("works"), needs=["begins"]),
            ],
        )
        for quiet_s in (0.1, 6.0)
    ]
    assert first == second
    assert states(first) == {
        "calm": "passed",
        "begins": "failed",
        "lasts": "failed",
        "goes-on": "failed",
        "after": "waits",
    }
    for id_, what, seen in (
        ("begins", "early.py is at work", "early.py:14: KeyError: 'speed'"),
        ("goes-on", "early.py is at work", "early.py:14: KeyError: 'speed'"),
        ("lasts", "over.py is at work", "it has ended"),
    ):
        *others, last = first[id_].checks
        assert last.what == what
        assert seen in last.seen
        assert {check.state for check in others} == {State.NOT_YET}


async def test_one_that_a_step_makes_crash_fails_that_step_alone(
    tmp_path: Path, ros_domain: int
) -> None:
    poked = {**POKE, "then": [{"log": "touchy", "matches": "poked"}]}
    found = await judged(
        tmp_path,
        ros_domain,
        TOUCHY,
        [
            step("begins", "touchy", is_ready("touchy")),
            step("is-poked", "touchy", poked),
            step("is-back", "touchy", {"node": "/touchy"}),
        ],
    )
    wanted = {"begins": "passed", "is-poked": "failed", "is-back": "passed"}
    assert states(found) == wanted, {id_: result.checks for id_, result in found.items()}
    assert "ZeroDivisionError" in found["is-poked"].checks[-1].seen

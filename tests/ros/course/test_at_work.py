"""No step passes while its node is not at work: dead, stuck, or silent to what all answer."""

from __future__ import annotations

import asyncio
import textwrap
from pathlib import Path

import pytest
import yaml

from course.judge.judge import judging
from course.lessons.lesson import LessonFolder
from course.results import State, StepResult
from launcher.client.client import launch
from tests.waiting import until

pytestmark = pytest.mark.nightly

NODE = """\
import threading
import time
import rclpy
from rclpy.node import Node
from std_srvs.srv import Trigger


class Own(Node):
    def __init__(self):
        super().__init__("{name}")
        self.client = self.create_client(Trigger, "nobody")
        self.count = 0
        self.create_timer(0.2, self.tick)
        print("ready", flush=True)
        {begin}

    def tick(self):
        self.count += 1
        {tick}


rclpy.init()
node = Own()
{spin}
"""
SPIN = "rclpy.spin(node)"
WAITS = "rclpy.spin_until_future_complete(self, self.client.call_async(Trigger.Request()))"
FOR_A_MOMENT = "rclpy.spin_once(node, timeout_sec=0.0); time.sleep(1.0)"
NODES: dict[str, tuple[dict[str, str], str]] = {
    "works": ({}, ""),
    "hangs": (
        {"begin": "while True: time.sleep(1)"},
        "",
    ),
    "waits": ({"begin": WAITS}, "__init__ in waits.py does not return"),
    "calls": ({"tick": "self.client.call(Trigger.Request())"}, "tick in calls.py does not return"),
    "crashes": ({"tick": 'print("now", flush=True); 1 / 0'}, "ZeroDivisionError: division by zero"),
    "ends": ({"spin": FOR_A_MOMENT}, "it has ended"),
}
"""What is unlike a node that is at work, and what is seen of it."""


async def test_a_step_passes_only_if_its_node_is_at_work(tmp_path: Path, ros_domain: int) -> None:
    """Each has done what its check asks for; the whole of what is said is the same each time."""
    parts = {"begin": "pass", "tick": "pass", "spin": SPIN}
    for name, (other, _seen) in NODES.items():
        text = textwrap.dedent(NODE).format(name=name, **{**parts, **other})
        (tmp_path / f"{name}.py").write_text(text)
    nodes = {name: {"run": f"./{name}.py", "restart": "on-failure"} for name in NODES}
    steps = [
        {
            "id": name,
            "file": f"{name}.py",
            "checks": [
                {"log": name, "matches": "now" if name == "crashes" else "ready", "within": 30}
            ],
        }
        for name in NODES
    ]
    (tmp_path / "lesson.yaml").write_text(yaml.safe_dump({"nodes": nodes, "steps": steps}))
    lesson = LessonFolder(tmp_path)
    client = await launch(tmp_path / "lesson.yaml", domain=ros_domain)
    try:
        async with judging(lesson, client, seed=1) as judge:
            await judge.settle()
            # It answers, so that it is at work for all one knows until it is told.
            await until(lambda: client.nodes["waits"].ails, "who waits for nobody ails")
            first, second = [
                dict(
                    zip(
                        NODES,
                        await asyncio.gather(*(judge.step(step) for step in lesson.steps)),
                        strict=True,
                    )
                )
                for _round in range(2)
            ]
    finally:
        await client.shutdown()
    assert first == second
    assert first["works"].state is State.PASSED
    for name, (_other, seen) in NODES.items():
        if name != "works":
            assert first[name].state is State.FAILED, name
            assert _last(first[name])[0] == f"{name}.py is at work"
            assert seen in _last(first[name])[1]
    assert "call_async" in _last(first["calls"])[2]


async def test_between_two_crashes_it_is_not_at_work(tmp_path: Path, ros_domain: int) -> None:
    """Each time it does what the check asks for, and answers, for two seconds."""
    begin = 'threading.Timer(2.0, lambda: os.abort()).start(); print("now", flush=True)'
    text = textwrap.dedent(NODE).format(name="crashes", begin=begin, tick="pass", spin=SPIN)
    (tmp_path / "crashes.py").write_text(f"import os\n{text}")
    node = {"run": "./crashes.py", "restart": "on-failure"}
    step = {"id": "now", "checks": [{"log": "crashes", "matches": "now", "within": 30}]}
    lesson_path = tmp_path / "lesson.yaml"
    lesson_path.write_text(yaml.safe_dump({"nodes": {"crashes": node}, "steps": [step]}))
    lesson = LessonFolder(tmp_path)
    client = await launch(lesson_path, domain=ros_domain)
    try:
        async with judging(lesson, client, seed=1) as judge:
            await until(
                lambda: client.nodes["crashes"].restarts and client.nodes["crashes"].pid,
                "the next process of one that has crashed",
            )
            result = await judge.step(lesson.steps[0])
    finally:
        await client.shutdown()
    assert result.state is State.FAILED
    assert _last(result)[0] == "crashes.py is at work"


def _last(result: StepResult) -> tuple[str, str, str]:
    check = result.checks[-1]
    return check.what, check.seen, check.look

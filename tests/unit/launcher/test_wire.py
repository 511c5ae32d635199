"""What goes through the control socket, and what a supervisor loads for it."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import pytest

from launcher.consent import Agent, Agents, Approval, Question
from launcher.events import (
    AgentsEvent,
    ClosedEvent,
    Event,
    LogEvent,
    StatusEvent,
    StraysEvent,
    UnguardedEvent,
    pack_event,
    unpack_event,
)
from launcher.status import LogLine, NodeFault, NodeState, NodeStatus, Severity, Stray
from launcher.supervisor.plan import Plan, plan_of
from launcher.wire import Sentence, unpack
from tests.unit.profile_files import loaded
from text.sentences import say

WORDS = say("waiting for {who}", who=say("{name} (not ready)", name="sonar"))
EVENTS: list[Event] = [
    StatusEvent((NodeStatus("gate", "x", NodeState.READY, WORDS, 1, 2.5, fault=NodeFault("crash", meaning=WORDS)),)),
    LogEvent((LogLine("gate", 1, 2.0, Severity.WARN, WORDS, "gate", "stdout"),), {"gate": 3}),
    StraysEvent((Stray(1, 2.0, "gate", "x", "run-1"),)),
    AgentsEvent(Agents((Agent("claude", Approval.ASK),), (Question(1, "claude", (WORDS,), 3.0),))),
    UnguardedEvent(),
    ClosedEvent(WORDS),
]


@pytest.mark.parametrize("event", EVENTS)
def test_an_event_comes_as_it_was_sent(event: Event) -> None:
    assert unpack_event(json.loads(json.dumps(pack_event(event)))) == event


def test_a_plan_comes_as_it_was_made(tmp_path: Path) -> None:
    profile = loaded(
        tmp_path, "nodes: {a: {run: nodes.hello, params: {x: [1.5, .inf]}, ready: {topic: /x, rate: 2}}}"
    )
    plan = plan_of(profile, run_dir="/r", log_dir="/l", foreground=True, node_lang="ru")
    assert Plan.from_json(plan.to_json()) == plan


@dataclass(frozen=True)
class Sent:
    number: float
    name: str | None = None
    pair: tuple[int, str] = (0, "")


@pytest.mark.parametrize(
    ("kind", "packed", "why"),
    [
        (int, True, "expected int"),
        (int, "1", "expected int"),
        (str, None, "expected str"),
        (Sent, {}, "cannot be read"),
        (Sent, {"number": 1, "name": 2}, "name: expected str, found 2"),
        (Sent, {"number": 1, "pair": [1]}, "pair: expected tuple"),
        (tuple[Sent, ...], [{"number": "x"}], "0: number: expected float"),
        (Severity, "loud", "loud"),
        (Literal["a", "b"], "c", "'c'"),
        (Sentence, 3, "cannot be read"),
        (LogLine, ["sonar", 1], "not enough values"),
    ],
)
def test_what_is_of_another_type_is_refused_with_its_place(kind: Any, packed: object, why: str) -> None:
    with pytest.raises(ValueError, match=why):
        unpack(kind, packed)


def test_a_supervisor_without_a_file_of_the_learners_loads_no_large_library() -> None:
    large = ("pydantic", "pydantic_core", "yaml", "psutil", "rclpy", "watchfiles", "launcher.faults.rules")
    code = f"import sys, launcher.supervisor.run\nprint(*set({large}) & sys.modules.keys())"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""

"""What the judge takes for a run, for progress, and for a task."""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import AsyncIterator
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest

from course.judge.evidence import TICK_S, Evidence
from course.judge.judge import Judge
from course.progress import load_progress, noted, state_of
from graph.data import NAMELESS, PROCESS_NUMBERS, EndpointInfo, GraphUpdate, NodeRow, TopicRow
from launcher.events import LogEvent, StatusEvent
from launcher.status import LogLine, NodeState, NodeStatus, Severity


class _ToldLate:
    """A client that has heard of a node, this process, when it was new, and hears of it no more."""

    def __init__(self, *lines: LogLine) -> None:
        status = NodeStatus("talker", "talker.py", NodeState.RUNNING, pid=os.getpid(), uptime_s=0.0)
        self.nodes = {"talker": status}
        self._lines = lines

    async def events(self, *, past: int) -> AsyncIterator[LogEvent]:
        yield LogEvent(self._lines[-past:])


async def test_what_a_node_says_before_its_judge_hears_of_it_counts() -> None:
    early = LogLine("talker", 1, time.time() - 0.5, Severity.INFO, "ready")
    before = LogLine("talker", 1, 1.0, Severity.INFO, "of an earlier run")
    client = cast("Any", _ToldLate(before, early))
    evidence = Evidence(cast("Any", None), client, Path(), {})
    await evidence.listen()
    assert [line.text for line in evidence.lines("talker", 0.0)] == ["ready"]


async def test_the_crash_before_a_quick_restart_is_not_that_of_the_new_process() -> None:
    """It is heard of later than the new process began: both are told in one breath."""
    client = _ToldLate()
    running = client.nodes["talker"]
    client.nodes["talker"] = replace(running, pid=os.getppid())
    told = (replace(running, state=NodeState.FAILED, pid=None), running)

    async def events(*, past: int) -> AsyncIterator[StatusEvent]:  # noqa: ARG001 - as a client's
        yield StatusEvent(told[:1])
        client.nodes["talker"] = running
        yield StatusEvent(told[1:])

    client.events = events  # type: ignore[method-assign, assignment]
    evidence = Evidence(cast("Any", None), cast("Any", client), Path(), {})
    await evidence.listen()
    began_s = evidence.began_s("talker")
    assert evidence.trouble("talker", began_s) is not None, "in the step it counts"
    evidence.forget_earlier_crash("talker")
    assert evidence.trouble("talker", began_s) is None


def _graph(pid: int, *nodes: str) -> GraphUpdate:
    process = pid % PROCESS_NUMBERS
    ends = tuple(EndpointInfo(node, "std_msgs/msg/Empty", "reliable", "volatile", process=process) for node in nodes)
    row = TopicRow("/heard", ("std_msgs/msg/Empty",), 0, len(ends), subscribed_by=ends)
    rows = tuple(NodeRow(end.node, processes=(process,)) for end in ends if end.is_named)
    return GraphUpdate(0.0, topics=(row,), nodes=rows)


@pytest.mark.parametrize(
    "early", [(), (f"/{NAMELESS}",), ("/another", f"/{NAMELESS}")], ids=["nothing", "no name", "one name of two"]
)
@pytest.mark.parametrize("name", ["/talker", "/of_another_name"])
async def test_nodes_are_judged_once_the_middleware_knows_them(
    early: tuple[str, ...], name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A node at work is not said to lack what the middleware is only late to tell."""
    monkeypatch.setattr("course.judge.judge.NAMED_WITHIN_S", 0.0)
    evidence = Evidence(cast("Any", None), cast("Any", _ToldLate()), Path(), {})
    evidence.take(_graph(os.getpid(), *early))
    judge = Judge(cast("Any", SimpleNamespace(steps=())), evidence)

    settling = asyncio.ensure_future(judge.settle())
    await evidence.let_pass(TICK_S)
    assert not settling.done()
    evidence.take(_graph(os.getpid(), name))
    await settling
    await judge.close()


LESSON = "02-sonar-safety"


@pytest.mark.parametrize(
    "broken",
    [
        b"",
        b"\xff\xfe",
        b"[1, 2]",
        b'{"lessons": {"02-sonar-safety": {"topic": {"passed"',
        b'{"lessons": [], "last": 7}',
        b'{"lessons": {"02-sonar-safety": {"topic": {"passed": 1, "points": 9999999}}}}',
        b"[" * 100_000,
        b" " * (1 << 21),
    ],
)
def test_a_broken_file_counts_as_nothing_done_and_is_kept_beside_the_next(tmp_path: Path, broken: bytes) -> None:
    path = tmp_path / "progress.json"
    path.write_bytes(broken)
    assert not load_progress(path).passed(LESSON)
    assert noted(LESSON, "rate", {"passed": True, "points": 2}, path).passed(LESSON) == {"rate"}
    assert load_progress(path).points(LESSON, {"rate"}) == 2
    assert path.with_name("progress.json.broken").read_bytes() == broken


def test_a_step_holds_with_the_files_that_it_passed_with(tmp_path: Path) -> None:
    path, file = tmp_path / "progress.json", tmp_path / "mine.py"
    file.write_text("right = 1")
    before = state_of([str(file)])
    noted(LESSON, "rate", {"passed": True, "points": 2, "files": before, "at": 5}, path)
    assert load_progress(path).held(LESSON, before) == {"rate"}
    file.write_text("right = 2")
    after = state_of([str(file)])
    assert load_progress(path).held(LESSON, after) == frozenset()
    assert load_progress(path).step(LESSON, "rate").at == 5
    file.write_text("right = 1")
    assert load_progress(path).held(LESSON, state_of([str(file)])) == {"rate"}

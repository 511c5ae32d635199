"""What the judge takes for a run of a node: all since it began, however late it is told."""

from __future__ import annotations

import os
import time
from collections.abc import AsyncIterator
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

from course.judge.evidence import Evidence
from launcher.events import LogEvent
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


def test_a_start_by_the_judge_counts_as_the_learners_if_the_file_was_saved_meanwhile(
    tmp_path: Path,
) -> None:
    """Saved between the judge's stop and its start, it is started once, for both reasons."""
    file = tmp_path / "talker.py"
    file.write_text("")
    status = NodeStatus("talker", "talker.py", NodeState.RUNNING, pid=os.getpid(), file=str(file))
    client = _ToldLate()
    client.nodes["talker"] = status
    evidence = Evidence(cast("Any", None), cast("Any", client), tmp_path, {})

    def started_by_the_judge(pid: int, saved_s: float) -> int:
        os.utime(file, (saved_s, saved_s))
        evidence.touched.add("talker")
        evidence.note_starts([replace(status, pid=pid)])
        return evidence.restarts

    assert started_by_the_judge(os.getppid(), 1.0) == 0
    assert started_by_the_judge(os.getpid(), time.time() + 1.0) == 1

"""What is left of a run; a hung supervisor is killed, and what it has started ends with it."""

from __future__ import annotations

import asyncio
import os
import signal
import time

from launcher.processes.members import is_marked
from launcher.processes.signal import send
from launcher.processes.table import NODE_MARK, RUN_MARK, Process, processes, read_marks
from launcher.run_id import living_supervisor, supervisor_of
from launcher.supervisor.words import who
from text.sentences import Words, say

GONE_WITHIN_S = 3.0
"""Within 2 s of a supervisor's being killed, everything it has started is gone."""
_LOOK_EVERY_S = 0.05


async def kill_supervisor(run_id: str) -> Words:
    """Kill the supervisor of a run; return the outcome once nothing is left, or after 3 s."""
    supervisor = living_supervisor(run_id)
    if supervisor is not None:
        send(supervisor, signal.SIGKILL)
    left = await left_behind(run_id)
    pid = supervisor_of(run_id)
    if not left:
        return say("the supervisor (pid {pid}) did not answer; it was killed with all its nodes", pid=pid)
    return say(
        "the supervisor (pid {pid}) did not answer and was killed; still running: {who}", pid=pid, who=who(left)
    )


async def left_behind(run_id: str) -> list[Process]:
    """Return what a supervisor that has said its last word leaves; it has 3 s to be gone itself."""
    deadline = time.monotonic() + GONE_WITHIN_S
    while (left := left_of(run_id)) and time.monotonic() < deadline:  # noqa: ASYNC110 - not ours
        await asyncio.sleep(_LOOK_EVERY_S)
    return left


def nodes_of(run_id: str) -> dict[str, int]:
    """Return the living nodes of a run with their process numbers, as the kernel knows them."""
    nodes: dict[str, int] = {}
    for each in sorted(processes(), key=lambda process: process.started_ticks):
        marks = None if each.zombie else read_marks(each.pid)
        if marks is not None and marks.get(RUN_MARK) == run_id:
            name = marks.get(NODE_MARK, "")
            # Others that it has started have its mark, and are younger.
            if name and not name.startswith("-"):
                nodes.setdefault(name, each.pid)
    return nodes


def left_of(run_id: str) -> list[Process]:
    """Return the processes of a run that are alive, its supervisor first."""
    supervisor = living_supervisor(run_id)
    marked = [each for each in processes() if each.pid != os.getpid() and not each.zombie and is_marked(each, run_id)]
    return marked if supervisor is None else [supervisor, *marked]

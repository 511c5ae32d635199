"""The running sessions: which one a name refers to, and what is left of one that hangs."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Sequence

from launcher.errors import NotRunningError, SeveralRunningError
from launcher.processes.members import is_marked
from launcher.processes.signal import send
from launcher.processes.table import NODE_MARK, RUN_MARK, Process, processes, read_marks
from launcher.profile.catalog import fitting, is_path
from launcher.run_id import living_supervisor, supervisor_of
from launcher.rundir import found_run_dir
from launcher.runs.record import RunRecord, read_records, supervisors
from launcher.supervisor.words import who
from text.run_path import OWN_RUN_DIR
from text.sentences import Words, say

GONE_WITHIN_S = 3.0
"""Within 2 s of a supervisor's being killed, everything it has started is gone."""
_LOOK_EVERY_S = 0.05


def running_records() -> list[RunRecord]:
    """Return all running sessions, oldest first, including those whose run directory was lost.

    Sessions with another `DECK_RUN_DIR` are left out.
    """
    here = found_run_dir()
    records = read_records(here) if here is not None else []
    found = {record.session.run_id: record for record in records if record.runs}
    for supervisor in supervisors():
        if supervisor.run_id in found or supervisor.purpose != os.environ.get(OWN_RUN_DIR, ""):
            continue
        record = supervisor.record()
        if record is not None:
            found[supervisor.run_id] = record
    return [found[run_id] for run_id in sorted(found)]


def find_running(name: str | None = None) -> RunRecord:
    """Return the running session: the only one, or the one with that run id or profile.

    A profile is given as it is for starting: by path, name, lesson number or start of a name.

    Raises:
        NotRunningError: if there is none.
        SeveralRunningError: if there are several to choose from.
    """
    found = running_records()
    chosen = found if name is None else _meant(name, found)
    names = [record.session.name for record in found]
    if not chosen:
        raise NotRunningError(name, names)
    if len(chosen) > 1:
        raise SeveralRunningError(names if len(set(names)) == len(names) else [one.session.run_id for one in chosen])
    return chosen[0]


def _meant(name: str, found: Sequence[RunRecord]) -> list[RunRecord]:
    exactly = [one for one in found if name in (one.session.name, one.session.run_id)]
    if exactly:
        return exactly
    if is_path(name):
        path = os.path.realpath(name)
        return [one for one in found if os.path.realpath(one.session.profile) == path]
    # Not looked up in the catalogue: the file may be gone, or not visible from here.
    fits = fitting(name, {one.session.name for one in found})
    return [one for one in found if one.session.name in fits]


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
    # `deck stop` begins here, and needs none of it.
    import asyncio

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

"""Processes that an earlier run left behind: their supervisor and guardian are gone.

This only happens when these and the spawn server are killed together. Such processes are
reported, and ended only on request.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from launcher.processes.stop import Clock, StopTimeouts, end_all
from launcher.processes.table import (
    GUARDIAN_NAME,
    NODE_MARK,
    RUN_MARK,
    TICKS_PER_S,
    Process,
    boot_time_s,
    command_line,
    processes,
    read_marks,
    read_process,
)
from launcher.run_id import supervisor_runs
from launcher.runs.record import read_records
from launcher.status import Stray
from text.run_path import OWN_RUN_DIR

_SAME_START_S = 1.5
"""Tolerance: the time of the boot is known to the second, and drifts with the clock."""
INTERRUPT_S = 2.0
"""From SIGINT to SIGKILL, and the longest wait after that."""


def find_strays() -> tuple[Stray, ...]:
    """Return the processes left over from runs whose supervisor is gone."""
    booted = boot_time_s()
    strays = []
    table = {process.pid: process for process in processes()}
    for process in table.values():
        if process.zombie or _is_guarded(process, table):
            continue
        run_id, node = _marked(process)
        if run_id:
            started_s = booted + process.started_ticks / TICKS_PER_S
            command = command_line(process.pid) or process.name
            strays.append(Stray(process.pid, started_s, node, command, run_id))
    return tuple(strays)


def _is_guarded(process: Process, table: Mapping[int, Process]) -> bool:
    """Whether a guardian is above it, which ends what its supervisor leaves.

    A robot in a container cannot be recognised by its supervisor: that has another pid in there.
    """
    seen: set[int] = set()
    at: Process | None = process
    while at is not None and at.pid not in seen:
        if at.name == GUARDIAN_NAME:
            return True
        seen.add(at.pid)
        at = table.get(at.parent)
    return False


def _marked(process: Process) -> tuple[str, str]:
    marks = read_marks(process.pid)
    if not marks or RUN_MARK not in marks:
        return "", ""
    # A user who keeps runs separate does not want to see the others.
    if marks.get(OWN_RUN_DIR, "") != os.environ.get(OWN_RUN_DIR, ""):
        return "", ""
    run_id, node = marks[RUN_MARK], marks.get(NODE_MARK, "")
    # A spawn server that outlives its supervisor is cleaning up, and ends by itself.
    if node.startswith("-") or supervisor_runs(run_id):
        return "", ""
    return run_id, node


def _found(stray: Stray) -> Process | None:
    """Return exactly this process if it is alive, not another with the same number."""
    process = read_process(stray.pid)
    if process is None or process.zombie:
        return None
    started_s = boot_time_s() + process.started_ticks / TICKS_PER_S
    if abs(started_s - stray.started_s) > _SAME_START_S or supervisor_runs(stray.run_id):
        return None
    return process


async def end_strays(strays: Sequence[Stray]) -> None:
    """End these processes: by SIGINT, and by SIGKILL those that remain."""

    def left() -> list[Process]:
        return [process for process in map(_found, strays) if process is not None]

    await end_all(left, Clock(), 2 * INTERRUPT_S, StopTimeouts(INTERRUPT_S, 0.0))


def forget_ended_runs(run_dir: Path, strays: Iterable[Stray]) -> None:
    """Remove the records of runs of which nothing is left."""
    kept = {stray.run_id for stray in strays}
    for record in read_records(run_dir):
        run_id = record.session.run_id
        # A copy of a record kept by a user has another name.
        if record.folder.name == run_id and run_id not in kept and not record.runs:
            record.remove()

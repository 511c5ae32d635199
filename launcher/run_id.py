"""The id of a run, which contains its start time and the identity of its supervisor process.

It has both the pid and the start time of that process, so that no other is mistaken for it.
"""

from __future__ import annotations

import os
import time

from launcher.processes.table import Process, read_process


def new_run_id() -> str:
    """Return an id for a run supervised by this process; ids sort by time."""
    process = read_process(os.getpid())
    started = process.started_ticks if process else 0
    return f"{time.strftime('%Y%m%d-%H%M%S')}-{os.getpid()}-{started}"


def supervisor_of(run_id: str) -> int:
    """Return the pid of the process that supervises, or supervised, this run; 0 if unknown."""
    return _process_of(run_id)[0]


def living_supervisor(run_id: str) -> Process | None:
    """Return the supervisor of this run; None if it is not alive."""
    pid, started = _process_of(run_id)
    process = read_process(pid) if pid > 0 else None
    if process is None or process.started_ticks != started or process.zombie:
        return None
    return process


def supervisor_runs(run_id: str) -> bool:
    """Whether the supervisor of this run is alive."""
    return living_supervisor(run_id) is not None


def is_of_supervisor(run_id: str, process: Process, number: int) -> bool:
    """Whether this is the supervisor of this run; `number` is its pid where it runs itself."""
    return (number, process.started_ticks) == _process_of(run_id) and not process.zombie


def _process_of(run_id: str) -> tuple[int, int]:
    try:
        pid, started = map(int, run_id.split("-")[-2:])
    except ValueError:
        return 0, 0
    return pid, started

"""The id of a run: it says when it began, and which process supervises it.

It holds the number and the start of that process, so that nobody mistakes another for it.
"""

from __future__ import annotations

import os
import time

from launcher.process_table import read_process


def new_run_id() -> str:
    """Return an id for a run whose supervisor is this process; ids sort by time."""
    process = read_process(os.getpid())
    started = process.started_ticks if process else 0
    return f"{time.strftime('%Y%m%d-%H%M%S')}-{os.getpid()}-{started}"


def supervisor_of(run_id: str) -> int:
    """Return the number of the process that supervises, or has supervised, this run; else 0."""
    return _process_of(run_id)[0]


def supervisor_runs(run_id: str) -> bool:
    """Whether the supervisor of this run is alive."""
    pid, started = _process_of(run_id)
    process = read_process(pid) if pid > 0 else None
    return process is not None and process.started_ticks == started and not process.zombie


def _process_of(run_id: str) -> tuple[int, int]:
    try:
        pid, started = map(int, run_id.split("-")[-2:])
    except ValueError:
        return 0, 0
    return pid, started

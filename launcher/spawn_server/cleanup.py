"""Cleanup by the spawn server after the supervisor's death: it ends what is left of the run.

The nodes themselves died with the supervisor (PDEATHSIG); their children and other processes that
left the nodes' groups did not.
"""

from __future__ import annotations

import os
import signal
import time
from typing import TYPE_CHECKING

from launcher.processes.abandoned import KILLED_AFTER_S, LEFT_AFTER_S
from launcher.processes.signal import send
from launcher.processes.table import RUN_MARK, processes, read_marks

if TYPE_CHECKING:
    from collections.abc import Iterable

    from launcher.processes.table import Process


def end_survivors(run_id: str, groups: Iterable[int]) -> None:
    """End all processes in `groups`, and all that are marked with `run_id`."""
    wanted = frozenset(groups)
    started = time.monotonic()
    told: set[int] = set()
    while True:
        left = survivors(run_id, wanted)
        elapsed = time.monotonic() - started
        if not left or elapsed > LEFT_AFTER_S:
            return
        for process in left:
            if elapsed >= KILLED_AFTER_S:
                send(process, signal.SIGKILL)
            elif process.pid not in told:
                send(process, signal.SIGINT)
        told.update(process.pid for process in left)
        time.sleep(0.05)


def survivors(run_id: str, groups: frozenset[int]) -> list[Process]:
    """Return the remaining processes of a run, without this one."""
    return [
        process
        for process in processes()
        if process.pid != os.getpid()
        and not process.zombie
        and (process.group in groups or (read_marks(process.pid) or {}).get(RUN_MARK) == run_id)
    ]

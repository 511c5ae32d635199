"""Ending processes whose supervisor is gone."""

from __future__ import annotations

import signal
import time
from typing import TYPE_CHECKING

from launcher.processes.signal import send

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from launcher.processes.table import Process

KILLED_AFTER_S = 0.7
"""From SIGINT to SIGKILL: together with the search, less than the promised 2 s."""
LEFT_AFTER_S = 10.0
"""After this time a process that SIGKILL does not end is left to the kernel."""
LOOK_EVERY_S = 0.05


def end_all(find: Callable[[], Sequence[Process]]) -> None:
    """End all processes that `find` returns, looking again until it returns none."""
    began_s = time.monotonic()
    told: set[int] = set()
    while left := find():
        elapsed_s = time.monotonic() - began_s
        if elapsed_s > LEFT_AFTER_S:
            return
        for process in left:
            if elapsed_s >= KILLED_AFTER_S:
                send(process, signal.SIGKILL)
            elif process.pid not in told:
                send(process, signal.SIGINT, signal.SIGCONT)
        told.update(process.pid for process in left)
        time.sleep(LOOK_EVERY_S)

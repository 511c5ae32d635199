"""Ending what an examiner leaves behind, should what it judged have ended its guardian."""

from __future__ import annotations

import os
import signal
import time
from contextlib import suppress
from typing import TYPE_CHECKING

from launcher.processes.signal import send
from launcher.processes.table import processes, read_marks
from text.run_path import OWN_RUN_DIR

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Sequence

    from launcher.processes.table import Process

ROUNDS = 100
ROUND_S = 0.02
"""How often to look again: a process may just be starting another one."""


def descendants(pid: int) -> list[Process]:
    """Return the living processes that descend from one, without that one."""
    children: dict[int, list[Process]] = {}
    for process in processes():
        children.setdefault(process.parent, []).append(process)
    found: list[Process] = []
    wanted = [pid]
    while wanted:
        below = children.pop(wanted.pop(), [])
        found += [process for process in below if not process.zombie]
        wanted += [process.pid for process in below]
    return found


def kill_descendants(pid: int) -> None:
    """Kill all that descends from a process, but not the process itself."""
    _kill_all(lambda: descendants(pid))


def end_marked(run_dir: str) -> None:
    """Kill all that has this run directory in its environment."""
    _kill_all(
        lambda: [
            each
            for each in processes()
            if not each.zombie and (read_marks(each.pid) or {}).get(OWN_RUN_DIR) == run_dir
        ]
    )


def end_adopted(kept: Collection[int]) -> None:
    """Kill all children of this process but these, with all that descends from them."""

    def left() -> list[Process]:
        adopted = [each for each in processes() if each.parent == os.getpid() and each.pid not in kept]
        for each in adopted:
            with suppress(ChildProcessError):
                os.waitpid(each.pid, os.WNOHANG)
        return [one for each in adopted for one in (each, *descendants(each.pid)) if not one.zombie]

    _kill_all(left)


def _kill_all(find: Callable[[], Sequence[Process]]) -> None:
    for _round in range(ROUNDS):
        left = find()
        if not left:
            return
        # Stopped first, so that none starts another meanwhile.
        for number in (signal.SIGSTOP, signal.SIGKILL):
            for each in left:
                send(each, number)
        time.sleep(ROUND_S)

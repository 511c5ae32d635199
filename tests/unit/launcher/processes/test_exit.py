"""Ends of children of which no signal has told."""

from __future__ import annotations

import os
import signal

from launcher.processes.exit import UNSEEN, Exit, Reaper
from launcher.processes.table import read_process


def child() -> tuple[int, int]:
    """Return the number and the start of a child that waits for a signal."""
    pid = os.fork()
    if pid == 0:
        signal.pause()
        os._exit(0)
    process = read_process(pid)
    assert process is not None
    return pid, process.started_ticks


def await_end(pid: int, flags: int = 0) -> None:
    """Wait for the end of a child, and reap it unless told otherwise."""
    os.waitid(os.P_PID, pid, os.WEXITED | flags)


async def test_an_end_whose_signal_was_lost_is_found_by_looking() -> None:
    reaper, (pid, started) = Reaper(), child()
    ended = reaper.exit_of(pid, started)
    reaper.look_for(pid, started)
    assert not ended.done()
    os.kill(pid, signal.SIGTERM)
    await_end(pid, os.WNOWAIT)
    reaper.look_for(pid, started)
    assert ended.result() == Exit(None, "SIGTERM")


async def test_the_end_of_who_was_reaped_by_somebody_else_is_known_as_unseen() -> None:
    reaper, (pid, started) = Reaper(), child()
    ended = reaper.exit_of(pid, started)
    os.kill(pid, signal.SIGKILL)
    await_end(pid)
    reaper.look_for(pid, started)
    assert ended.result() == UNSEEN

"""How processes end, and waiting for it: the supervisor's children and those it adopted."""

from __future__ import annotations

import asyncio
import os
import signal
from dataclasses import dataclass

from launcher.processes.table import read_process


@dataclass(frozen=True)
class Exit:
    """The end of a process: an exit code or a signal."""

    code: int | None
    signal: str | None = None
    """The name of the signal: `SIGKILL`."""

    @classmethod
    def from_wait_status(cls, status: int) -> Exit:
        """Read a status from waitpid(2)."""
        if os.WIFSIGNALED(status):
            return cls(None, signal_name(os.WTERMSIG(status)))
        return cls(os.WEXITSTATUS(status))

    @property
    def clean(self) -> bool:
        """Whether it ended by itself with exit code 0."""
        return self.code == 0


UNSEEN = Exit(None)
"""The end of a process that is gone, and that somebody else has reaped."""


def signal_name(number: int) -> str:
    """Return `SIGINT` for 2; real-time signals only have numbers."""
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"SIG{number}"


class Reaper:
    """Reaps every child that ends, adopted orphans included, and informs whoever waits for it.

    A child is identified by its number and its start: the number alone may have been reused by the
    time somebody asks.
    """

    _FORGOTTEN = 256
    """How many ends are kept of children that nobody has asked about yet."""

    def __init__(self) -> None:
        self._awaited: dict[tuple[int, int], asyncio.Future[Exit]] = {}
        self._early: dict[tuple[int, int], Exit] = {}

    def install(self, loop: asyncio.AbstractEventLoop) -> None:
        loop.add_signal_handler(signal.SIGCHLD, self.collect)
        self.collect()

    def collect(self) -> None:
        """Reap every child that has ended."""
        while True:
            try:
                ended = os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT)
            except ChildProcessError:
                return
            if ended is None:
                return
            # Until it is reaped it keeps its number and its entry in /proc.
            process = read_process(ended.si_pid)
            _pid, status = os.waitpid(ended.si_pid, 0)
            started_ticks = process.started_ticks if process else 0
            self._ended((ended.si_pid, started_ticks), Exit.from_wait_status(status))

    def look_for(self, pid: int, started_ticks: int) -> None:
        """Look anew for the end of a child of which nobody has told: the signal may be lost."""
        self.collect()
        key = (pid, started_ticks)
        if key in self._awaited:
            process = read_process(pid)
            if process is None or process.started_ticks != started_ticks:
                self._ended(key, UNSEEN)

    def exit_of(self, pid: int, started_ticks: int) -> asyncio.Future[Exit]:
        """Return a future for the end of a child; call it once for each."""
        future: asyncio.Future[Exit] = asyncio.get_running_loop().create_future()
        key = (pid, started_ticks)
        if key in self._early:
            future.set_result(self._early.pop(key))
        else:
            self._awaited[key] = future
        return future

    def _ended(self, key: tuple[int, int], end: Exit) -> None:
        future = self._awaited.pop(key, None)
        if future is None:
            self._early[key] = end
            if len(self._early) > self._FORGOTTEN:
                del self._early[next(iter(self._early))]
        elif not future.done():
            future.set_result(end)

"""How a process ended, and who waits for it: the supervisor's children and those it adopted."""

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
    """Its name: `SIGKILL`."""

    @classmethod
    def from_wait_status(cls, status: int) -> Exit:
        """Read what waitpid(2) gives."""
        if os.WIFSIGNALED(status):
            return cls(None, signal_name(os.WTERMSIG(status)))
        return cls(os.WEXITSTATUS(status))

    @property
    def clean(self) -> bool:
        """Whether it ended by itself and said that all was well."""
        return self.code == 0


def signal_name(number: int) -> str:
    """Return `SIGINT` for 2; real-time signals have numbers only."""
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"SIG{number}"


class Reaper:
    """Collects every child that ends, the adopted orphans too, and tells whoever waits for one.

    A child is its number and its start: the number alone may be another's by the time it is
    asked for.
    """

    _FORGOTTEN = 256
    """Ends kept for children that nobody has asked for yet."""

    def __init__(self) -> None:
        self._awaited: dict[tuple[int, int], asyncio.Future[Exit]] = {}
        self._early: dict[tuple[int, int], Exit] = {}

    def install(self, loop: asyncio.AbstractEventLoop) -> None:
        """Collect from now on."""
        loop.add_signal_handler(signal.SIGCHLD, self.collect)
        self.collect()

    def collect(self) -> None:
        """Collect every child that has ended."""
        while True:
            try:
                ended = os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT)
            except ChildProcessError:
                return
            if ended is None:
                return
            # Until it is reaped it keeps its number, and /proc tells of it.
            process = read_process(ended.si_pid)
            _pid, status = os.waitpid(ended.si_pid, 0)
            started_ticks = process.started_ticks if process else 0
            self._ended((ended.si_pid, started_ticks), Exit.from_wait_status(status))

    def exit_of(self, pid: int, started_ticks: int) -> asyncio.Future[Exit]:
        """Return the future end of a child; ask once for each."""
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

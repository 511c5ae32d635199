"""How a process ended, and who waits for it: the supervisor's children and those it adopted."""

from __future__ import annotations

import asyncio
import os
import signal
from dataclasses import dataclass


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
    """Collects every child that ends, the adopted orphans too, and tells who waits for one."""

    _FORGOTTEN = 256
    """Ends kept for children that nobody has asked for yet."""

    def __init__(self) -> None:
        self._awaited: dict[int, asyncio.Future[Exit]] = {}
        self._early: dict[int, Exit] = {}

    def install(self, loop: asyncio.AbstractEventLoop) -> None:
        """Collect from now on."""
        loop.add_signal_handler(signal.SIGCHLD, self.collect)
        self.collect()

    def collect(self) -> None:
        """Collect every child that has ended."""
        while True:
            try:
                pid, status = os.waitpid(-1, os.WNOHANG)
            except ChildProcessError:
                return
            if pid == 0:
                return
            self._ended(pid, Exit.from_wait_status(status))

    def exit_of(self, pid: int) -> asyncio.Future[Exit]:
        """Return the future end of a child; ask once for each."""
        future: asyncio.Future[Exit] = asyncio.get_running_loop().create_future()
        if pid in self._early:
            future.set_result(self._early.pop(pid))
        else:
            self._awaited[pid] = future
        return future

    def _ended(self, pid: int, end: Exit) -> None:
        future = self._awaited.pop(pid, None)
        if future is None:
            self._early[pid] = end
            if len(self._early) > self._FORGOTTEN:
                del self._early[next(iter(self._early))]
        elif not future.done():
            future.set_result(end)

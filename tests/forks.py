"""Processes forked from one that has imported ahead what they need; each test worker has one."""

from __future__ import annotations

import multiprocessing
import os
import subprocess
from typing import TYPE_CHECKING
from unittest import mock

from launcher.processes.prctl import room_for_marks

if TYPE_CHECKING:
    import signal
    from collections.abc import Callable, Mapping, Sequence
    from multiprocessing.context import ForkServerProcess

_FORKS = multiprocessing.get_context("forkserver")
_FORKS.set_forkserver_preload(
    [
        *("cli.main", "cli.listing", "cli.background", "cli.run", "cli.record", "cli.replay"),
        *("launcher.supervisor.run", "tests.ros.warm_imports", "tests.ros.told_actions"),
    ]
)


class Forked:
    """A forked process, with what of `subprocess.Popen` tests use."""

    def __init__(self, argv: Sequence[str], target: Callable[..., None], *arguments: object) -> None:
        """Start one that does this, as the program `argv`."""
        self.args = tuple(argv)
        self._process = fork(target, *arguments)

    @property
    def pid(self) -> int:
        assert self._process.pid is not None
        return self._process.pid

    @property
    def returncode(self) -> int | None:
        return self._process.exitcode

    def poll(self) -> int | None:
        return self._process.exitcode

    def wait(self, timeout: float | None = None) -> int:
        self._process.join(timeout)
        if self._process.exitcode is None:
            raise subprocess.TimeoutExpired(self.args, timeout or 0.0)
        return self._process.exitcode

    def send_signal(self, number: signal.Signals) -> None:
        """Send a signal, unless it has ended."""
        if self._process.exitcode is None:
            os.kill(self.pid, number)

    def kill(self) -> None:
        self._process.kill()


def fork(target: Callable[..., None], *arguments: object) -> ForkServerProcess:
    # The process that all are forked from starts with the first one.
    with mock.patch.dict(os.environ, room_for_marks()):
        process = _FORKS.Process(target=target, args=arguments, daemon=True)
        process.start()
    return process


def enter(cwd: str, env: Mapping[str, str]) -> None:
    """In such a process: have this working folder, and this environment and no other."""
    os.environ.clear()
    os.environ.update(env)
    os.chdir(cwd)

"""Processes forked from one that has imported ahead what they need; each test worker has one."""

from __future__ import annotations

import multiprocessing
import os
from typing import TYPE_CHECKING
from unittest import mock

from launcher.processes.title import room_for_marks

if TYPE_CHECKING:
    import signal
    from collections.abc import Callable, Mapping
    from multiprocessing.context import ForkServerProcess

_FORKS = multiprocessing.get_context("forkserver")
_FORKS.set_forkserver_preload(
    [
        *("cli.main", "cli.listing", "cli.background", "cli.run", "cli.record", "cli.replay"),
        *("launcher.supervisor.run", "tests.ros.warm_imports", "tests.ros.told_actions"),
    ]
)


def fork(target: Callable[..., None], *arguments: object) -> ForkServerProcess:
    """Start a process that does this."""
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


def send(process: ForkServerProcess, number: signal.Signals) -> None:
    """Send a signal, unless it has ended."""
    if process.exitcode is None:
        assert process.pid is not None
        os.kill(process.pid, number)

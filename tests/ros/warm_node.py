"""A node in a process forked from one that has rclpy and its messages already, as Deck forks it.

Saved is the start of Python and the imports, most of what the start of a node costs. What Python
reads when it starts (PYTHON..., permissions) has no effect here: see `NodeProcess`.
"""

from __future__ import annotations

import os
import signal
import subprocess
from typing import TYPE_CHECKING

from launcher import node_program
from launcher.spawn_server.node import check_fields, renew_streams
from tests.forks import enter, fork, send

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


class WarmNode:
    """Such a process, with what of `subprocess.Popen` tests use."""

    def __init__(self, argv: Sequence[str], *, cwd: str, env: Mapping[str, str], log: int) -> None:
        """Run a module with its arguments; what it prints goes to the descriptor `log`."""
        output = f"/proc/{os.getpid()}/fd/{log}"
        self._process = fork(_become, tuple(argv), cwd, dict(env), output)
        self.args = tuple(argv)

    @property
    def pid(self) -> int:
        assert self._process.pid is not None
        return self._process.pid

    @property
    def returncode(self) -> int | None:
        return self._process.exitcode

    def poll(self) -> int | None:
        return self._process.exitcode

    def wait(self, within_s: float) -> int:
        self._process.join(within_s)
        if self._process.exitcode is None:
            raise subprocess.TimeoutExpired(self.args, within_s)
        return self._process.exitcode

    def send_signal(self, number: signal.Signals) -> None:
        send(self._process, number)


def _become(argv: tuple[str, ...], cwd: str, env: dict[str, str], output: str) -> None:
    from tests.ros import warm_imports

    os.setsid()
    opened = os.open(output, os.O_WRONLY | os.O_APPEND)
    for stream in (1, 2):
        os.dup2(opened, stream)
    os.close(opened)
    enter(cwd, env)
    renew_streams()
    node_program.prepare(argv)
    warm_imports.SHARED.renew(argv[0])
    check_fields(env["ROS_PYTHON_CHECK_FIELDS"])
    node_program.run(argv[0])

"""A lesson node as a process of its own, as a person would start it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
from typing import TYPE_CHECKING

from tests.middleware_words import own_words
from tests.ros.peer import DISCOVERY, ROOT
from tests.ros.warm_node import WarmNode
from tests.waiting import DEADLINE_S, wait_until

if TYPE_CHECKING:
    from typing_extensions import Self


def _as_anyone() -> tuple[str, ...]:
    """Return what keeps root to the permissions of files, too; nothing for everybody else."""
    if os.geteuid() != 0:
        return ()
    return ("setpriv", "--bounding-set=-dac_override,-dac_read_search")


class NodeProcess:
    """`python -m MODULE --ros-args -p NAME:=VALUE ...`; its output goes to a file.

    It is forked, warm, as Deck does it. `cold`: it is started by Python. `mortal`: it is cold, and
    may not open what it has no permission for, whoever runs the tests.
    """

    def __init__(
        self,
        module: str,
        domain: int,
        *,
        name: str = "",
        params: dict[str, object] | None = None,
        lang: str = "en",
        arguments: tuple[str, ...] = (),
        cold: bool = False,
        mortal: bool = False,
    ) -> None:
        self.module = module
        argv = [module, *arguments]
        if name or params:
            argv.append("--ros-args")
        if name:
            argv += ["-r", f"__node:={name}"]
        for key, value in (params or {}).items():
            argv += ["-p", f"{key}:={str(value).lower() if value in (True, False) else value}"]
        environment = {
            **os.environ,
            "ROS_DOMAIN_ID": str(domain),
            **DISCOVERY,
            "ROS_PYTHON_CHECK_FIELDS": "1",
            "PYTHONUNBUFFERED": "1",
            "DECK_LANG": lang,
        }
        self._log = tempfile.TemporaryFile("w+b")  # noqa: SIM115 - closed in `close`
        self.hung = False
        """Whether it has ever been told to."""
        if not (cold or mortal):
            self.process: WarmNode | subprocess.Popen[bytes] = WarmNode(
                argv, cwd=str(ROOT), env=environment, log=self._log.fileno()
            )
            return
        self.process = subprocess.Popen(
            [*(_as_anyone() if mortal else ()), sys.executable, "-m", *argv],
            cwd=ROOT,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=self._log,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def output(self) -> str:
        """All that it has written so far in its own words."""
        size = os.fstat(self._log.fileno()).st_size
        return own_words(os.pread(self._log.fileno(), size, 0).decode("utf-8", "replace"))

    def wait_for_words(self, *words: str) -> None:
        """Wait until it has written these words, in any order."""
        wait_until(
            lambda: all(word in self.output for word in words) or self._stop_waiting(words),
            f"{words} in the output of {self.module}",
        )

    def send(self, number: signal.Signals) -> None:
        """Send a signal; after one to kill, wait for the end."""
        self.hung |= number == signal.SIGSTOP
        self.process.send_signal(number)
        if number == signal.SIGKILL:
            self.wait()

    def wait(self, within_s: float = DEADLINE_S) -> int:
        """Wait for the end; the exit code comes back."""
        return self.process.wait(within_s)

    def close(self) -> None:
        if self.process.poll() is None:
            self.send(signal.SIGINT)
            try:
                self.wait(10)
            except subprocess.TimeoutExpired:
                self.send(signal.SIGKILL)
        self._log.close()

    def _stop_waiting(self, words: tuple[str, ...]) -> bool:
        if self.process.poll() is None:
            return False
        raise AssertionError(f"{self.module} ended with {self.process.returncode} before {words}:\n{self.output}")

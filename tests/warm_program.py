"""A module run as a program in a process forked from one that has its modules already.

Saved is the start of Python and the imports: half a second of a core each time. What Python reads
when it starts (LANG, PYTHON...) has no effect here: tests of that start it for real.
"""

from __future__ import annotations

import atexit
import os
import runpy
import signal
import subprocess
import sys
import threading
from multiprocessing import reduction
from typing import IO, TYPE_CHECKING, Any, NoReturn

from tests.forks import Forked, enter

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

PIPE, DEVNULL = subprocess.PIPE, subprocess.DEVNULL


class WarmProgram(Forked):
    """`python -m MODULE ARGUMENTS`."""

    def __init__(
        self,
        argv: Sequence[str],
        *,
        cwd: str,
        env: Mapping[str, str],
        stdin: int = DEVNULL,
        stdout: int = PIPE,
        stderr: int = PIPE,
    ) -> None:
        """`argv`: the module and its arguments; streams are PIPE, DEVNULL or a descriptor."""
        self.stdin: IO[str] | None = None
        self.stdout: IO[str] | None = None
        self.stderr: IO[str] | None = None
        theirs: list[int] = []
        made: list[int] = []
        for name, wanted in (("stdin", stdin), ("stdout", stdout), ("stderr", stderr)):
            if wanted == DEVNULL:
                made.append(os.open(os.devnull, os.O_RDWR))
                theirs.append(made[-1])
            elif wanted == PIPE:
                ours, other = self._pipe(writes=name == "stdin")
                setattr(self, name, ours)
                made.append(other)
                theirs.append(other)
            else:
                theirs.append(wanted)
        streams = tuple(Passed(fd) for fd in theirs)
        super().__init__(argv, _become, tuple(argv), cwd, dict(env), streams)
        for fd in made:
            os.close(fd)

    @staticmethod
    def _pipe(*, writes: bool) -> tuple[IO[str], int]:
        reading, writing = os.pipe()
        if writes:
            return os.fdopen(writing, "w", encoding="utf-8"), reading
        return os.fdopen(reading, "r", encoding="utf-8"), writing


class Passed:
    """A descriptor that the process gets; in it, it is a number again."""

    def __init__(self, fd: int) -> None:
        self._fd = fd

    def __reduce__(self) -> tuple[Any, ...]:
        return _number, (reduction.DupFd(self._fd),)


def _number(passed: Any) -> int:
    fd: int = passed.detach()
    return fd


def _become(argv: tuple[str, ...], cwd: str, env: dict[str, str], streams: tuple[int, ...]) -> None:
    from launcher.spawn_server.node import renew_streams

    for stream, fd in enumerate(streams):
        os.dup2(fd, stream)
        os.close(fd)
    enter(cwd, env)
    renew_streams()
    sys.argv[:] = argv
    try:
        runpy.run_module(argv[0], run_name="__main__", alter_sys=True)
    except BaseException as error:  # noqa: BLE001 - as Python itself
        end(error)
    end(SystemExit(0))


def end(error: BaseException) -> NoReturn:
    code = error.code if isinstance(error, SystemExit) else 1
    if not isinstance(error, SystemExit):
        trace = error.__traceback__
        # Without the frame here.
        sys.excepthook(type(error), error, trace and trace.tb_next)
    elif isinstance(code, str):
        sys.stderr.write(f"{code}\n")
    threading._shutdown()  # type: ignore[attr-defined]
    atexit._run_exitfuncs()
    sys.stdout.flush()
    if isinstance(error, KeyboardInterrupt):
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGINT)
    os._exit(1 if isinstance(code, str) else code or 0)

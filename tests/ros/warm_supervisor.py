"""A supervisor forked from a process that has its modules, and those of its nodes, already.

Saved is the start of Python and the imports, of the supervisor and of its spawn server: most of
what a short session costs. What is read when a program starts, its environment as others see it for
one, differs here: tests of that are marked `cold`, and start it as Deck does.
"""

from __future__ import annotations

import os
import subprocess
import sys
from typing import TYPE_CHECKING

from tests.forks import Forked, enter
from tests.warm_program import Passed, end

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

PIPE = subprocess.PIPE


class Popen(Forked):
    """Such a process."""

    def __init__(
        self, argv: Sequence[str], *, cwd: Path, env: Mapping[str, str], stderr: int, **_as_always: object
    ) -> None:
        """Start `PYTHON -m launcher.supervisor ...`; stdin and stdout are pipes."""
        theirs_in, ours_in = os.pipe()
        ours_out, theirs_out = os.pipe()
        streams = tuple(Passed(fd) for fd in (theirs_in, theirs_out, stderr))
        program = tuple(argv[2:])
        super().__init__(program, _become, program, str(cwd), dict(env), streams, os.getpid())
        os.close(theirs_in)
        os.close(theirs_out)
        self.stdin, self.stdout = os.fdopen(ours_in, "wb", 0), os.fdopen(ours_out, "rb", 0)


def _become(argv: tuple[str, ...], cwd: str, env: dict[str, str], streams: tuple[int, ...], client: int) -> None:
    os.setsid()
    for stream, fd in enumerate(streams):
        os.dup2(fd, stream)
        os.close(fd)
    enter(cwd, env)

    from launcher.spawn_server.node import check_fields, renew_streams
    from launcher.supervisor import __main__ as program

    renew_streams()
    check_fields(env.get("ROS_PYTHON_CHECK_FIELDS", ""))
    sys.argv[:] = argv
    parent = os.getppid

    def started_by() -> int:
        os.getppid = parent
        return client

    os.getppid = started_by
    # The guardian, the supervisor, the spawn server and its nodes: all of them come back here.
    try:
        program.main()
    except BaseException as error:  # noqa: BLE001 - as Python itself
        end(error)
    end(SystemExit(0))

"""`deck` in processes forked from one that has its modules already: a tenth of a start's cost.

What is saved is the start of Python and the imports, half a second of a core each time. What Python
itself reads when it starts (LANG, PYTHON...) has no effect here: tests of that start it for real.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from tests.forks import enter, fork

if TYPE_CHECKING:
    from collections.abc import Mapping


def forked_deck(
    *arguments: str, out: Path, err: Path, env: Mapping[str, str] | None = None, within_s: float = 60
) -> int:
    """Run `deck ARGUMENTS` with its output in these files, or on a terminal; return its exit code.

    `env` is added to this process's environment. Without an end in time it is killed.
    """
    environ = {**os.environ, **(env or {})}
    command = fork(_become, arguments, environ, str(Path.cwd()), str(out), str(err))
    command.join(within_s)
    if command.exitcode is None:
        command.kill()
        command.join()
        raise TimeoutError(f"deck {' '.join(arguments)} takes longer than {within_s} s")
    return command.exitcode


def _become(arguments: tuple[str, ...], environ: dict[str, str], folder: str, out: str, err: str) -> None:
    from cli import main

    enter(folder, environ)
    for path, stream in ((out, 1), (err, 2)):
        opened = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_NOCTTY, 0o600)
        os.dup2(opened, stream)
        os.close(opened)
    sys.stdout = open(1, "w", encoding="utf-8", closefd=False)  # noqa: SIM115
    sys.stderr = open(2, "w", encoding="utf-8", errors="backslashreplace", closefd=False)  # noqa: SIM115
    sys.argv[:] = ["deck", *arguments]
    sys.exit(main())

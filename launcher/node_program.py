"""Running a node's module or file, here in this process: `python node_program.py NODE ARGUMENTS`.

Like `python -m MODULE` and `python FILE`, save for where modules are looked for: `-m` would look
in the current folder first, and take whatever lies there for a part of Deck or of ROS. Here the
current folder is no place at all. Deck's installation goes first for Deck's own nodes and last for
others, since a `graph` or a `text` may be there that they mean.
"""

from __future__ import annotations

import os
import sys

TYPE_CHECKING = False  # That of `typing` would cost each start the import.
if TYPE_CHECKING:
    from types import TracebackType

OURS, _, _ = __file__.rpartition("/")
INSTALLATION, _, _ = OURS.rpartition("/")
"""Where the packages of Deck are."""


def prepare(argv: tuple[str, ...]) -> None:
    """Have this process look like the program of a node: `argv` begins with its module or file."""
    name = argv[0]
    places = [place for place in sys.path if place not in (INSTALLATION, "")]
    sys.path[:] = [INSTALLATION, *places] if is_ours(name) else [*places, INSTALLATION]
    if "/" in name:
        sys.path.insert(0, name.rpartition("/")[0])
    sys.excepthook = _report
    sys.orig_argv = [sys.executable, __file__, *argv]
    # Packages of nodes see by it that one of them is being started, as under `python -m`.
    sys.argv = [name if "/" in name else "-m", *argv[1:]]


def is_ours(name: str) -> bool:
    """Whether a node's module or file is a module of Deck."""
    return "/" not in name and name.partition(".")[0] in os.listdir(INSTALLATION)  # noqa: PTH208


def run(name: str) -> None:
    """Run a module or file as the program of this process, which is prepared for it."""
    import runpy

    if "/" in name:
        runpy.run_path(name, run_name="__main__")
    else:
        runpy.run_module(name, run_name="__main__", alter_sys=True)


def _report(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    """Print an uncaught exception without the frames that belong to the launcher."""
    import traceback

    while trace is not None and _is_ours(trace.tb_frame.f_code.co_filename):
        trace = trace.tb_next
    traceback.print_exception(kind, error, trace)


def _is_ours(file: str) -> bool:
    import runpy

    standard = str(runpy.__file__).rpartition("/")[0]
    return file.startswith(("<frozen runpy", f"{OURS}/")) or file.rpartition("/")[0] == standard


if __name__ == "__main__":
    # As a program, it is its own folder that Python looks in first.
    sys.path[:] = [place for place in sys.path if place != OURS]
    _argv = tuple(sys.argv[1:])
    prepare(_argv)
    run(_argv[0])

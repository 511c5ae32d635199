"""Running a file on the shell of `deck shell` as `python3 FILE` would, and explaining its end.

The command `python3` there is `launcher/prefix/bin/python3`, which comes here with a file: below
the traceback of an uncaught exception stands one sentence on what it means.
"""

from __future__ import annotations

import contextlib
import os
import runpy
import sys

TYPE_CHECKING = False  # Importing `typing` for this would slow down every start.
if TYPE_CHECKING:
    from types import TracebackType

OURS, _, _ = __file__.rpartition("/")


def main(argv: list[str]) -> None:
    """Run the file `argv[0]` with its arguments."""
    program = runpy.run_path(f"{OURS}/node_program.py")
    file = os.path.abspath(argv[0])  # noqa: PTH100
    program["prepare"]((file, *argv[1:]), tells=False)
    sys.argv[0] = argv[0]
    report = sys.excepthook

    def explain(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        report(kind, error, trace)
        with contextlib.suppress(Exception), program["deck_modules"]():
            _explain(file, error)

    sys.excepthook = explain
    program["run"](file)


def _explain(file: str, error: BaseException) -> None:
    from launcher.faults.explain import explained
    from text.i18n import detect, localized, set_language
    from text.output import say_error

    set_language(detect())
    fault = explained(error, file)
    if fault.meaning:
        place = f"{fault.file.rpartition('/')[2]}:{fault.line}"
        sys.stdout.flush()
        say_error(f"{place}: {localized(fault.meaning)}")


if __name__ == "__main__":
    # When this file is run as a program, Python searches the folder it is in first.
    sys.path[:] = [place for place in sys.path if place != OURS]
    main(sys.argv[1:])

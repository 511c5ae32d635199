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
    program["prepare"]((file, *argv[1:]))
    sys.argv[0] = argv[0]
    report = sys.excepthook

    def explain(
        kind: type[BaseException], error: BaseException, trace: TracebackType | None
    ) -> None:
        report(kind, error, trace)
        with contextlib.suppress(Exception):
            _explain(program["INSTALLATION"], file, error)

    sys.excepthook = explain
    program["run"](file)


def _explain(installation: str, file: str, error: BaseException) -> None:
    """Print the sentence. The learner's own `launcher` or `text` is no longer needed."""
    for name in [name for name in sys.modules if name.partition(".")[0] in ("launcher", "text")]:
        del sys.modules[name]
    sys.path.insert(0, installation)
    import traceback

    from launcher.faults.crash import crash_of
    from text.i18n import detect, localized, set_language
    from text.output import say_error

    set_language(detect())
    printed = "".join(traceback.format_exception(None, error, error.__traceback__))
    fault = crash_of(printed.splitlines(), file.rpartition("/")[0])
    if fault is not None and fault.meaning:
        place = f"{fault.file.rpartition('/')[2]}:{fault.line}"
        sys.stdout.flush()
        say_error(f"{place}: {localized(fault.meaning)}")


if __name__ == "__main__":
    # When this file is run as a program, Python searches the folder it is in first.
    sys.path[:] = [place for place in sys.path if place != OURS]
    main(sys.argv[1:])

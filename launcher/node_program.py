"""Running a node's module or file in this process: `python node_program.py NODE ARGUMENTS`.

Like `python -m MODULE` and `python FILE`, except for the module search path: `-m` would look in the
current folder first, and take whatever is there for a part of Deck or ROS. Here the current folder
is not searched at all. Deck's installation comes first for Deck's own nodes and last for others,
which may have a `graph` or `text` of their own. After all of it come the packages of ROS that PyPI
does not have: a ROS that brings them itself is found before.
"""

from __future__ import annotations

import os
import sys

TYPE_CHECKING = False  # Importing `typing` for this would slow down every start.
if TYPE_CHECKING:
    from types import TracebackType

OURS, _, _ = __file__.rpartition("/")
INSTALLATION, _, _ = OURS.rpartition("/")
"""The folder that Deck's packages are in."""

BRIDGES = f"{INSTALLATION}/bridges"
"""The folder of cv_bridge and tf2_ros, for a ROS that comes without them."""


def prepare(argv: tuple[str, ...], *, tells: bool = True) -> None:
    """Make this process look like a node's program; `argv` begins with its module or file.

    `tells`: a supervisor reads what it prints, and gets what is wrong with a learner's program.
    """
    name = argv[0]
    places = [place for place in sys.path if place not in (INSTALLATION, BRIDGES, "")]
    sys.path[:] = [INSTALLATION, *places] if is_ours(name) else [*places, INSTALLATION]
    sys.path.append(BRIDGES)
    if "/" in name:
        sys.path.insert(0, name.rpartition("/")[0])
        # Saved twice within a second, a module beside it would be taken for the first one.
        sys.dont_write_bytecode = True
    sys.excepthook = _report
    if tells and "/" in name:
        sys.excepthook = _report_and_tell
        _report_threads()
        _report_actions()
    sys.orig_argv = [sys.executable, __file__, *argv]
    # The `-m` tells the nodes' packages that one of their modules is being started.
    sys.argv = [name if "/" in name else "-m", *argv[1:]]


def is_ours(name: str) -> bool:
    """Whether a node's module or file is part of Deck."""
    return "/" not in name and name.partition(".")[0] in os.listdir(INSTALLATION)  # noqa: PTH208


def run(name: str) -> None:
    """Run a module or file as the program of this process; call `prepare` first."""
    import runpy

    if "/" in name:
        # Not imported: the learner may have a `launcher` of his own.
        changes = runpy.run_path(f"{OURS}/rclpy_changes.py")
        changes["allow_bytes"]()
        tells = sys.excepthook is _report_and_tell
        if tells:
            changes["keep_names"](name)
        _watch(name.rpartition("/")[0], tells=tells)
        runpy.run_path(name, run_name="__main__")
    else:
        runpy.run_module(name, run_name="__main__", alter_sys=True)


def _watch(folder: str, *, tells: bool) -> None:
    """Watch the callbacks of a learner's program, by a package under a name that nobody has."""
    import importlib
    import importlib.util

    alias, place = "deck_callback_watch", f"{OURS}/callback_watch"
    spec = importlib.util.spec_from_file_location(alias, f"{place}/__init__.py", submodule_search_locations=[place])
    if spec is not None:
        sys.modules[alias] = importlib.util.module_from_spec(spec)
        watching = importlib.import_module(f"{alias}.watch")
        watching.watch(folder, tells=tells)


def _report(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    """Print an uncaught exception without the frames that belong to the launcher."""
    import traceback

    while trace is not None and _is_ours(trace.tb_frame.f_code.co_filename):
        trace = trace.tb_next
    traceback.print_exception(kind, error, trace)


def _report_and_tell(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    _report(kind, error, trace)
    tell(error, sys.argv[0], "crash")


def _report_threads() -> None:
    """Tell of an exception that has ended a thread, too, of which nobody else takes notice."""
    import threading

    shown = threading.excepthook

    def report(ended: threading.ExceptHookArgs) -> None:
        shown(ended)
        if ended.exc_value is not None:
            tell(ended.exc_value, sys.argv[0], "thread")

    threading.excepthook = report


def _report_actions() -> None:
    """Tell of an exception in the callback of an action's server, too, which rclpy only logs."""
    import traceback

    shown = traceback.print_exc

    def report(*arguments: object, **options: object) -> None:
        shown(*arguments, **options)  # type: ignore[arg-type]
        error, asked = sys.exc_info()[1], sys._getframe(1).f_code.co_filename  # noqa: SLF001
        if error is not None and asked.endswith("/rclpy/action/server.py"):
            tell(error, sys.argv[0], "warning")

    traceback.print_exc = report


def tell(error: BaseException, file: str, kind: str) -> None:
    """Print, in a way that no terminal shows, what is wrong with the learner's own program."""
    import contextlib

    with contextlib.suppress(Exception), deck_modules():
        from launcher.faults.explain import explained
        from launcher.faults.telling import line_of

        line = line_of(explained(error, file, kind))
        sys.stderr.flush()
        os.write(2, line)


class deck_modules:  # noqa: N801 - used as a function
    """Makes Deck's own modules importable, where the learner has a `text` or `launcher` of his own.

    Only for a moment: other threads of his program may run on.
    """

    def __enter__(self) -> None:
        names = ("launcher", "text")
        self._theirs = {
            name: module
            for name, module in tuple(sys.modules.items())
            if name.partition(".")[0] in names and not _is_in_installation(module)
        }
        for name in self._theirs:
            del sys.modules[name]
        self._path = list(sys.path)
        sys.path.insert(0, INSTALLATION)

    def __exit__(self, *_error: object) -> None:
        sys.path[:] = self._path
        if self._theirs:
            for name in tuple(sys.modules):
                if name.partition(".")[0] in ("launcher", "text"):
                    del sys.modules[name]
            sys.modules.update(self._theirs)


def _is_in_installation(module: object) -> bool:
    return str(getattr(module, "__file__", "")).startswith(f"{INSTALLATION}/")


def _is_ours(file: str) -> bool:
    import runpy

    standard = str(runpy.__file__).rpartition("/")[0]
    return file.startswith(("<frozen runpy", f"{OURS}/")) or file.rpartition("/")[0] == standard


if __name__ == "__main__":
    # When this file is run as a program, Python searches the folder it is in first.
    sys.path[:] = [place for place in sys.path if place != OURS]
    _argv = tuple(sys.argv[1:])
    prepare(_argv)
    run(_argv[0])

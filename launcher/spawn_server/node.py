"""Turning a freshly forked process into a node: its session, descriptors and program."""

from __future__ import annotations

import contextlib
import importlib
import io
import os
import runpy  # noqa: F401 - imported ahead for all forked nodes
import signal
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from launcher import node_program
from launcher.faults import CHECK_FIELDS
from launcher.processes.prctl import die_with_parent, leave_libraries_alone_at_exit
from launcher.processes.table import NODE_MARK
from launcher.processes.title import show_mark, show_name, show_title
from text.plain import plain

if TYPE_CHECKING:
    from launcher.spawn_server.preload import Preload
    from launcher.spawn_server.shared_modules import SharedModules

ENDING = (signal.SIGINT, signal.SIGTERM)
NOT_EXECUTABLE = 126
NOT_FOUND = 127
"""The exit codes that a shell uses."""


@dataclass(frozen=True)
class ForkSpec:
    """Everything a forked process needs to know to become its node."""

    kind: str
    """`module`: run here, in the warm interpreter; `exec`: a program; `probe`: the graph probe;
    `lifecycle`: watch one node's lifecycle."""
    name: str
    title: str
    argv: tuple[str, ...]
    """For `module`: the module or file with its arguments; for `exec`: the command line."""
    env: dict[str, str | None]
    """Changes to the server's environment; None unsets."""
    cwd: str
    fds: tuple[int, ...]
    """The descriptors for stdout and stderr, or for stdin, stdout and stderr."""
    supervisor: int
    shared: SharedModules
    """The project's own modules that have been imported."""

    @classmethod
    def from_request(cls, request: dict[str, Any], fds: list[int], supervisor: int, preload: Preload) -> ForkSpec:
        """Read a request; if the imports have failed, modules are started cold."""
        kind, argv = str(request["kind"]), tuple(map(str, request["argv"]))
        if kind == "module" and preload.broken:
            kind, argv = "exec", (sys.executable, node_program.__file__, *argv)
        return cls(
            kind=kind,
            name=request["name"],
            title=request["title"],
            argv=argv,
            env=dict(request["env"]),
            cwd=request["cwd"],
            fds=tuple(fds),
            supervisor=supervisor,
            shared=preload.shared,
        )


def become(spec: ForkSpec) -> None:
    """Run as the node until it ends; an exception in the node ends this process as usual."""
    os.setsid()
    if not die_with_parent(spec.supervisor):
        os._exit(1)
    _reset_signals()
    _take_descriptors(spec.fds)
    _set_environment(spec)
    try:
        os.chdir(spec.cwd)
    except OSError as problem:
        _give_up(f"cannot enter {spec.cwd}: {problem.strerror}", NOT_EXECUTABLE)
    if spec.kind == "exec":
        _hear_signals()
        _execute(spec)
    show_title(spec.title)
    show_name(spec.name)
    show_mark(NODE_MARK, spec.name)
    renew_streams()
    if spec.kind == "probe":
        _hear_signals()
        from launcher.spawn_server.probe import probe

        probe(spec.argv)
    elif spec.kind == "lifecycle":
        _hear_signals()
        from launcher.spawn_server.lifecycle import watch_lifecycle

        watch_lifecycle(spec.argv)
    else:
        _run_module(spec.argv, spec.shared)


def _reset_signals() -> None:
    """Reset inherited signal handling, above all ignored signals, which exec would preserve."""
    for number in signal.valid_signals() - {signal.SIGKILL, signal.SIGSTOP}:
        if signal.getsignal(number) is not signal.SIG_DFL:
            with contextlib.suppress(OSError, ValueError):
                signal.signal(number, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_SETMASK, ENDING)


def _hear_signals() -> None:
    signal.pthread_sigmask(signal.SIG_SETMASK, ())


def _set_environment(spec: ForkSpec) -> None:
    os.environ[NODE_MARK] = spec.name
    for name, value in spec.env.items():
        if value is None:
            os.environ.pop(name, None)
        else:
            os.environ[name] = value


def _take_descriptors(fds: tuple[int, ...]) -> None:
    if len(fds) == 2:
        fds = (os.open(os.devnull, os.O_RDONLY), *fds)
    for target, fd in enumerate(fds):
        os.dup2(fd, target)
    for entry in os.listdir("/proc/self/fd"):  # noqa: PTH208
        if int(entry) > 2:
            with contextlib.suppress(OSError):
                os.close(int(entry))


def _execute(spec: ForkSpec) -> None:
    try:
        os.execvp(spec.argv[0], spec.argv)
    except FileNotFoundError:
        _give_up(f"command not found: {spec.argv[0]}", NOT_FOUND)
    except OSError as problem:
        _give_up(f"cannot execute {spec.argv[0]}: {problem.strerror}", NOT_EXECUTABLE)


def _give_up(word: str, code: int) -> None:
    os.write(2, f"deck: {plain(word)}\n".encode(errors="backslashreplace"))
    os._exit(code)


def renew_streams() -> None:
    """Reopen stdin, stdout and stderr, unbuffered as under `python -u`."""
    stdin = open(0, encoding="utf-8", closefd=False)  # noqa: SIM115
    sys.stdin = sys.__stdin__ = stdin  # type: ignore[misc]
    sys.stdout = sys.__stdout__ = _unbuffered(1)  # type: ignore[misc]
    sys.stderr = sys.__stderr__ = _unbuffered(2)  # type: ignore[misc]


def _unbuffered(fd: int) -> io.TextIOWrapper:
    raw = io.FileIO(fd, "w", closefd=False)
    return io.TextIOWrapper(raw, encoding="utf-8", errors="backslashreplace", write_through=True)


def check_fields(wanted: str) -> None:
    """Have the messages imported so far check their fields as a new interpreter would."""
    for module in tuple(sys.modules.values()):
        if hasattr(module, "ros_python_check_fields"):
            module.ros_python_check_fields = wanted  # type: ignore[attr-defined]


def _run_module(argv: tuple[str, ...], shared: SharedModules) -> None:
    """Run as the program that `launcher.node_program` would start in a new interpreter."""
    # Python's defaults at startup, which `_reset_signals` has undone.
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    node_program.prepare(argv)
    importlib.invalidate_caches()
    shared.renew(argv[0])
    check_fields(os.environ.get(CHECK_FIELDS, ""))
    _hear_signals()
    if signal.getsignal(signal.SIGINT) is signal.SIG_DFL:
        # Not earlier: interrupted before this point, it ends without a traceback.
        signal.signal(signal.SIGINT, signal.default_int_handler)
    if "numpy.random" in sys.modules:
        # `random` reseeds itself after a fork; numpy's legacy global generator does not.
        sys.modules["numpy.random"].seed()
    leave_libraries_alone_at_exit()
    node_program.run(argv[0])

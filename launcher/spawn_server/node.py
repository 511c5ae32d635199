"""Turning a freshly forked process into a node: its session, descriptors and program."""

from __future__ import annotations

import contextlib
import importlib
import io
import os
import runpy  # noqa: F401 - imported ahead for all forked nodes
import signal
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from launcher import node_program
from launcher.faults import CHECK_FIELDS
from launcher.processes.prctl import (
    die_with_parent,
    leave_libraries_alone_at_exit,
    set_short_name,
    show_mark,
    show_title,
)
from launcher.processes.table import NODE_MARK
from launcher.spawn_server import SpawnRequest
from text.plain import plain

if TYPE_CHECKING:
    from launcher.spawn_server.preload import Preload

ENDING = (signal.SIGINT, signal.SIGTERM)
NOT_EXECUTABLE = 126
NOT_FOUND = 127
"""The exit codes that a shell uses."""


def become(request: SpawnRequest, fds: Sequence[int], supervisor: int, preload: Preload) -> None:
    """Run as the node until it ends; an exception in the node ends this process as usual.

    `fds` are the descriptors for stdout and stderr, or for stdin, stdout and stderr.
    """
    os.setsid()
    if not die_with_parent(supervisor):
        os._exit(1)
    _reset_signals()
    _take_descriptors(fds)
    _set_environment(request)
    try:
        os.chdir(request.cwd)
    except OSError as problem:
        _give_up(f"cannot enter {request.cwd}: {problem.strerror}", NOT_EXECUTABLE)
    if request.kind == "exec":
        _execute(request.argv)
    elif request.kind == "module" and preload.broken:
        _execute((sys.executable, node_program.__file__, *request.argv))
    show_title(request.title)
    set_short_name(request.name)
    show_mark(NODE_MARK, request.name)
    renew_streams()
    if request.kind == "module":
        _run_module(request.argv, preload)
        return
    _hear_signals()
    if request.kind == "probe":
        from launcher.spawn_server.probe import probe

        probe(request.argv)
    else:
        from launcher.spawn_server.lifecycle import watch_lifecycle

        watch_lifecycle(request.argv)


def _reset_signals() -> None:
    """Reset inherited signal handling, above all ignored signals, which exec would preserve."""
    for number in signal.valid_signals() - {signal.SIGKILL, signal.SIGSTOP}:
        if signal.getsignal(number) is not signal.SIG_DFL:
            with contextlib.suppress(OSError, ValueError):
                signal.signal(number, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_SETMASK, ENDING)


def _hear_signals() -> None:
    signal.pthread_sigmask(signal.SIG_SETMASK, ())


def _set_environment(request: SpawnRequest) -> None:
    os.environ[NODE_MARK] = request.name
    for name, value in request.env.items():
        if value is None:
            os.environ.pop(name, None)
        else:
            os.environ[name] = value


def _take_descriptors(fds: Sequence[int]) -> None:
    if len(fds) == 2:
        fds = (os.open(os.devnull, os.O_RDONLY), *fds)
    for target, fd in enumerate(fds):
        os.dup2(fd, target)
    for entry in os.listdir("/proc/self/fd"):  # noqa: PTH208
        if int(entry) > 2:
            with contextlib.suppress(OSError):
                os.close(int(entry))


def _execute(argv: tuple[str, ...]) -> None:
    _hear_signals()
    try:
        os.execvp(argv[0], argv)
    except FileNotFoundError:
        _give_up(f"command not found: {argv[0]}", NOT_FOUND)
    except OSError as problem:
        _give_up(f"cannot execute {argv[0]}: {problem.strerror}", NOT_EXECUTABLE)


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


def _run_module(argv: tuple[str, ...], preload: Preload) -> None:
    """Run as the program that `launcher.node_program` would start in a new interpreter."""
    # Python's defaults at startup, which `_reset_signals` has undone.
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    node_program.prepare(argv)
    importlib.invalidate_caches()
    preload.renew(argv[0])
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

"""What this process is to the kernel: whose life its own is tied to, and what others see of it.

A supervisor adopts every descendant whose parent ends (`become_subreaper`), and a node dies with
the supervisor (`die_with_parent`). A forked process does not touch what is left of its parent's
threads when it exits (`leave_libraries_alone_at_exit`).

It also keeps the argument and environment areas of the process it was forked from. Here it overwrites them in
place, so that people, and the search for a run's processes, see a node and not a copy of the supervisor.
(setproctitle would write the title over the environment, and so over the marks.) The program that such processes
are forked from must be started with spare room: `ROOM_ARGUMENT` and `room_for_marks`.
"""

from __future__ import annotations

import atexit
import ctypes
import os
import signal
import time

from launcher.processes.table import NODE_MARK, RUN_MARK, SUPERVISOR_MARK, stat_fields

_PR_SET_PDEATHSIG = 1
_PR_SET_NAME = 15
_PR_SET_CHILD_SUBREAPER = 36

_libc = ctypes.CDLL(None, use_errno=True)


def _prctl(option: int, value: int) -> None:
    if _libc.prctl(ctypes.c_int(option), ctypes.c_ulong(value), 0, 0, 0) != 0:
        code = ctypes.get_errno()
        raise OSError(code, os.strerror(code))


def become_subreaper(yes: bool = True) -> None:
    """Become the parent of every descendant whose own parent ends; or stop doing so."""
    _prctl(_PR_SET_CHILD_SUBREAPER, yes)


def die_with_parent(parent: int, within_s: float = 10.0) -> bool:
    """Wait until `parent` is the parent of this process, then die when it does.

    Call it in a process whose real parent is about to exit and leave it to its subreaper. The
    kernel sends no signal for a parent that died before the call, hence the check afterwards.

    Returns:
        False if it is an orphan: `parent` is already gone.
    """
    at_first = os.getppid()
    deadline = time.monotonic() + within_s
    while True:
        now = os.getppid()
        if now == parent:
            break
        if now != at_first or time.monotonic() > deadline:
            return False
        time.sleep(0.0005)
    _prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    return os.getppid() == parent


def set_short_name(name: str) -> None:
    """Set the name that `top` and `ps -o comm` show, cut to 15 bytes."""
    short = ctypes.create_string_buffer(name.encode()[:15])
    _libc.prctl(ctypes.c_int(_PR_SET_NAME), short, 0, 0, 0)


def leave_libraries_alone_at_exit() -> None:
    """Have exit(3) end this process before the destructors of libraries loaded so far.

    Call it after a fork. LTTng, which comes with rclpy, has a destructor that cancels threads which
    only the parent had; their stacks may be gone by then, and nodes that ended well died of
    SIGSEGV.
    """
    atexit.register(_libc.fflush, None)
    # Called with the exit code, after Python has shut down.
    _libc.on_exit(_libc._exit, None)  # noqa: SLF001 - this is its name in libc


ROOM_ARGUMENT = "-" * 160
"""The last argument of a command line, which provides the room for titles."""
_ROOM = {RUN_MARK: "-" * 80, NODE_MARK: "-" * 255, SUPERVISOR_MARK: "-" * 90}

_ARG_START, _ARG_END, _ENV_START, _ENV_END = range(48, 52)  # fields of /proc/self/stat, proc(5)


def room_for_marks() -> dict[str, str]:
    """Return environment variables that provide room for the marks."""
    return dict(_ROOM)


def show_title(title: str) -> None:
    """Make this process appear as `title`."""
    areas = _areas()
    _write(areas[_ARG_START], areas[_ARG_END], title.encode())


def show_mark(mark: str, text: str) -> bool:
    """Set a mark of this process; return False if its environment has no room for it."""
    areas = _areas()
    start, end = areas[_ENV_START], areas[_ENV_END]
    room = f"{mark}={_ROOM[mark]}".encode()
    at = ctypes.string_at(start, end - start).find(room)
    if at < 0:
        return False
    value = start + at + len(mark) + 1
    _write(value, start + at + len(room) + 1, text.encode())
    return True


def _areas() -> dict[int, int]:
    with open("/proc/self/stat", "rb") as file:  # noqa: PTH123 - only once per node
        stat = file.read()
    fields = stat_fields(stat)
    return {number: int(fields[number - 3]) for number in range(_ARG_START, _ENV_END + 1)}


def _write(start: int, end: int, text: bytes) -> None:
    """Write `text`, cut if necessary, and zeros up to `end`."""
    room = end - start - 1
    if room > 0:
        ctypes.memmove(start, text[:room].ljust(room + 1, b"\0"), room + 1)

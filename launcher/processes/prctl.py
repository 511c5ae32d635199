"""Tying the life of one process to that of another: prctl(2) and similar calls.

A supervisor adopts every descendant whose parent ends (`become_subreaper`), and a node dies with
the supervisor (`die_with_parent`). A forked process does not touch what is left of its parent's
threads when it exits (`leave_libraries_alone_at_exit`).
"""

from __future__ import annotations

import atexit
import ctypes
import os
import signal
import time

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

"""Confining a process for good: Landlock (landlock(7)), which needs no privileges.

A confined process, and all that it starts, writes nowhere but in the folders it is given, in
shared memory and to /dev/null, and, since Linux 6.12, signals and traces only its own kind. What it
reads, runs and sends is its own affair. On a kernel without Landlock nothing happens.
"""

from __future__ import annotations

import ctypes
import os
import stat
from enum import Enum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

ALWAYS = ("/dev/shm", "/dev/null", "/dev/zero", "/dev/full", "/dev/tty")
"""Where everybody may write: DDS talks through shared memory."""

_CREATE_RULESET, _ADD_RULE, _RESTRICT_SELF = 444, 445, 446
"""The numbers of these calls, on every architecture (asm-generic/unistd.h)."""
_VERSION = 1
_PATH_BENEATH = 1
_NO_NEW_PRIVS = 38
_WRITE_FILE, _REFER, _TRUNCATE = 1 << 1, 1 << 13, 1 << 14
_CHANGES_FOLDERS = sum(1 << bit for bit in range(4, 13))
"""Removing, and making files of every kind."""
_SCOPES = 0b11
"""Abstract sockets, and signals."""
_SIGNALS_SINCE = 6
"""The version of Landlock, of Linux 6.12."""

_libc = ctypes.CDLL(None, use_errno=True)


class Confinement(Enum):
    """What this kernel can keep a process from."""

    NONE = "none"
    FILES = "files"
    """Writing elsewhere."""
    FULL = "full"
    """That, and signals to others."""


class _Ruleset(ctypes.Structure):
    _fields_ = (
        ("files", ctypes.c_uint64),
        ("net", ctypes.c_uint64),
        ("scoped", ctypes.c_uint64),
    )


class _PathBeneath(ctypes.Structure):
    _pack_ = 1
    _layout_ = "ms"
    _fields_ = (("allowed", ctypes.c_uint64), ("folder", ctypes.c_int32))


def confinement() -> Confinement:
    """Return what `confine` does on this kernel."""
    version = _version()
    if version < 1:
        return Confinement.NONE
    return Confinement.FULL if version >= _SIGNALS_SINCE else Confinement.FILES


def confine(folders: Iterable[str]) -> None:
    """Confine this process, which has a single thread, to these folders, as far as possible.

    Raises:
        OSError: if a folder is missing, or the kernel refuses.
    """
    version = _version()
    if version < 1:
        return
    handled = _WRITE_FILE | _CHANGES_FOLDERS
    handled |= (_REFER if version >= 2 else 0) | (_TRUNCATE if version >= 3 else 0)
    full = version >= _SIGNALS_SINCE
    rules = _Ruleset(handled, 0, _SCOPES if full else 0)
    size = ctypes.sizeof(rules) if full else ctypes.sizeof(ctypes.c_uint64)
    ruleset = _call(_CREATE_RULESET, ctypes.byref(rules), ctypes.c_size_t(size), 0)
    try:
        for folder in folders:
            _allow(ruleset, folder, handled)
        for path in filter(os.path.exists, ALWAYS):
            _allow(ruleset, path, handled)
        if _libc.prctl(_NO_NEW_PRIVS, 1, 0, 0, 0) != 0:
            _fail()
        _call(_RESTRICT_SELF, ruleset, 0)
    finally:
        os.close(ruleset)


def _allow(ruleset: int, path: str, handled: int) -> None:
    descriptor = os.open(path, os.O_PATH | os.O_CLOEXEC)
    try:
        if not stat.S_ISDIR(os.fstat(descriptor).st_mode):
            handled &= _WRITE_FILE | _TRUNCATE
        beneath = _PathBeneath(handled, descriptor)
        _call(_ADD_RULE, ruleset, _PATH_BENEATH, ctypes.byref(beneath), 0)
    finally:
        os.close(descriptor)


def _version() -> int:
    return int(_libc.syscall(_CREATE_RULESET, None, 0, _VERSION))


def _call(number: int, *arguments: object) -> int:
    result = int(_libc.syscall(number, *arguments))
    if result < 0:
        _fail()
    return result


def _fail() -> None:
    code = ctypes.get_errno()
    raise OSError(code, os.strerror(code))

"""Confining a process for good, by what needs no privileges: Landlock (landlock(7)) and seccomp.

A confined process, and all that it starts, writes nowhere but in the folders it is given, in
shared memory and to /dev/null, changes no file's mode, owner or times, and no other process's
limits or priority, signals and traces only its own kind, and reaches no socket in the file system.
What it reads and runs is its own affair. Root also loses its privileges, but for reading.
"""

from __future__ import annotations

import ctypes
import os
import platform
import stat
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.processes.system_calls import can_refuse, refuse_calls

if TYPE_CHECKING:
    from collections.abc import Iterable

ALWAYS = ("/dev/shm", "/dev/null", "/dev/zero", "/dev/full", "/dev/tty")
"""Where everybody may write."""

_CREATE_RULESET, _ADD_RULE, _RESTRICT_SELF = 444, 445, 446
"""The numbers of these calls, on every architecture (asm-generic/unistd.h)."""
_VERSION = 1
_PATH_BENEATH = 1
_NO_NEW_PRIVS = 38
_WRITE_FILE, _REFER, _TRUNCATE = 1 << 1, 1 << 13, 1 << 14
_CHANGES_FOLDERS = sum(1 << bit for bit in range(4, 13))
"""Removing, and making files of every kind."""
_IOCTL_DEVICE = 1 << 15
_TCP = 0b11
"""Binding and connecting."""
_SCOPES = 0b11
"""Abstract sockets, and signals."""
_REFER_SINCE, _TRUNCATE_SINCE, _TCP_SINCE, _IOCTL_SINCE, _SIGNALS_SINCE = 2, 3, 4, 5, 6
"""Versions of Landlock; the last is that of Linux 6.12."""
_CAPSET, _DROP_BOUND, _READ_EVERYTHING = {"x86_64": 126, "aarch64": 91}, 24, 2
_CAPABILITIES_VERSION = 0x20080522

_libc = ctypes.CDLL(None, use_errno=True)


class Confinement(Enum):
    """What this kernel can keep a process from."""

    NONE = "none"
    FILES = "files"
    """Writing elsewhere."""
    FULL = "full"
    """That, and signals to others."""


class _Ruleset(ctypes.Structure):
    _fields_ = (("files", ctypes.c_uint64), ("net", ctypes.c_uint64), ("scoped", ctypes.c_uint64))


class _PathBeneath(ctypes.Structure):
    _pack_ = 1
    _layout_ = "ms"
    _fields_ = (("allowed", ctypes.c_uint64), ("folder", ctypes.c_int32))


def confinement() -> Confinement:
    """Return what `confine` does on this kernel."""
    version = _version()
    if version < 1:
        return Confinement.NONE
    keeps_signals = version >= _SIGNALS_SINCE or can_refuse()
    return Confinement.FULL if keeps_signals else Confinement.FILES


def is_confined(pid: int) -> bool:
    """Whether a process carries what `confine` leaves on it for good; so does one that is gone."""
    try:
        theirs, ours = _filters(pid), _filters(os.getpid())
    except (OSError, ValueError):
        return True
    return theirs[0] and theirs[1] > ours[1]


def is_elsewhere(pid: int) -> bool:
    """Whether a process is in another user or process namespace, or cannot be looked at."""
    try:
        return any(
            Path(f"/proc/{pid}/ns/{kind}").readlink() != Path(f"/proc/self/ns/{kind}").readlink()
            for kind in ("user", "pid")
        )
    except OSError:
        return True


def _filters(pid: int) -> tuple[bool, int]:
    """Return whether a process can gain no privileges, and how many filters of calls it has."""
    with open(f"/proc/{pid}/status", encoding="utf-8", errors="replace") as file:  # noqa: PTH123
        fields = dict(line.split(":", 1) for line in file if ":" in line)
    # Before Linux 5.9 it is only told whether there are any.
    filters = fields.get("Seccomp_filters", fields.get("Seccomp", "0"))
    return fields.get("NoNewPrivs", "0").strip() == "1", int(filters)


def confine(folders: Iterable[str]) -> None:
    """Confine this process, which has a single thread, to these folders, as far as possible.

    Raises:
        OSError: if a folder is missing, or the kernel refuses.
    """
    version = _version()
    if version < 1 and not can_refuse():
        return
    if os.geteuid() == 0:
        give_up_privileges()
    if _libc.prctl(_NO_NEW_PRIVS, 1, 0, 0, 0) != 0:
        _fail()
    if version >= 1:
        _restrict(folders, version)
    if can_refuse():
        refuse_calls(signals=version < _SIGNALS_SINCE)


def _restrict(folders: Iterable[str], version: int) -> None:
    handled = _WRITE_FILE | _CHANGES_FOLDERS
    for right, since in ((_REFER, _REFER_SINCE), (_TRUNCATE, _TRUNCATE_SINCE), (_IOCTL_DEVICE, _IOCTL_SINCE)):
        handled |= right if version >= since else 0
    full = version >= _SIGNALS_SINCE
    tcp = version >= _TCP_SINCE
    rules = _Ruleset(handled, _TCP if tcp else 0, _SCOPES if full else 0)
    known = 3 if full else 2 if tcp else 1
    size = ctypes.c_size_t(known * ctypes.sizeof(ctypes.c_uint64))
    ruleset = _call(_CREATE_RULESET, ctypes.byref(rules), size, 0)
    try:
        for folder in folders:
            _allow(ruleset, folder, handled)
        for path in filter(os.path.exists, ALWAYS):
            _allow(ruleset, path, handled)
        _call(_RESTRICT_SELF, ruleset, 0)
    finally:
        os.close(ruleset)


def give_up_privileges() -> None:
    """Keep of root's privileges only that of reading: Deck may be in somebody's home."""
    for capability in range(64):
        if capability != _READ_EVERYTHING:
            _libc.prctl(_DROP_BOUND, capability, 0, 0, 0)
    number = _CAPSET.get(platform.machine())
    if number is None:
        return
    header = (ctypes.c_uint32 * 2)(_CAPABILITIES_VERSION, 0)
    # Effective, permitted and inheritable, twice 32 of each.
    kept = (ctypes.c_uint32 * 6)(1 << _READ_EVERYTHING, 1 << _READ_EVERYTHING)
    if _libc.syscall(number, ctypes.byref(header), ctypes.byref(kept)) != 0:
        kept = (ctypes.c_uint32 * 6)()
        _call(number, ctypes.byref(header), ctypes.byref(kept))


def _allow(ruleset: int, path: str, handled: int) -> None:
    descriptor = os.open(path, os.O_PATH | os.O_CLOEXEC)
    try:
        if not stat.S_ISDIR(os.fstat(descriptor).st_mode):
            handled &= _WRITE_FILE | _TRUNCATE | _IOCTL_DEVICE
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

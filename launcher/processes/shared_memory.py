"""Shared memory that Fast DDS nodes leave behind when they are killed.

A participant holds a segment `/dev/shm/fastrtps_<16 hex digits>`, half a megabyte, and ports that
it listens on, `/dev/shm/fastrtps_port<number>`. For as long as it lives it has an exclusive
flock(2) on a file beside each, `..._el`. A node that ends properly removes them all; when one is
killed, its locks are released and the files stay.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import re
import stat
import time
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

SHARED_MEMORY = Path("/dev/shm")
NAME = r"fastrtps_(?:[0-9a-f]{16}|port\d+)"
"""The names of the files of segments and ports, as a regular expression."""
_LOCK = re.compile(f"({NAME})_el")
_PORT = "fastrtps_port"
STATES = (b"", b"\0\0\0\0", b"\1\0\0\0", b"\2\0\0\0", b"\3\0\0\0")
"""The first word of such a file, in which boost.interprocess keeps the state of its creation:
uninitialized, initializing, initialized, corrupted."""
_READ = os.O_RDONLY | os.O_CLOEXEC | os.O_NOFOLLOW | os.O_NONBLOCK
_ABANDONED_S = 10.0
"""Age from which a lock that nobody holds is abandoned, and not about to be taken."""


def held_segments(pid: int) -> set[str]:
    """Return the names of the segments and ports that a process has locked."""
    found = set()
    folder = f"/proc/{pid}/fd"
    with contextlib.suppress(OSError):
        for descriptor in os.listdir(folder):  # noqa: PTH208
            with contextlib.suppress(OSError):
                target = Path(os.readlink(f"{folder}/{descriptor}"))  # noqa: PTH115
                match = _LOCK.fullmatch(target.name)
                if match is not None and target.parent == SHARED_MEMORY:
                    found.add(match[1])
    return found


def mapped_segments(pid: int) -> set[str]:
    """Return the names of the segments and ports in a process's memory, without removed ones.

    Raises:
        OSError: if the process has gone, or may not be inspected.
    """
    lines = Path(f"/proc/{pid}/maps").read_text(errors="replace").splitlines()
    found = (line.rpartition(f"{SHARED_MEMORY}/")[2] for line in lines)
    return {name for name in found if name.startswith("fastrtps_") and not name.endswith(" (deleted)")}


def lost_ports(pid: int) -> set[str]:
    """Return the names of the ports that a process listens at, and nobody can reach any more.

    Fast DDS 2.14 removes a port's memory while somebody listens there, if the one before is just
    leaving it, or if the listener gets no processor for a second. The lock stays, so the name is
    taken; who opens the port from then on writes into memory of its own.
    """
    held = {name for name in held_segments(pid) if name.startswith(_PORT)}
    with contextlib.suppress(OSError):
        return held - mapped_segments(pid)
    return set()


def port_numbers(names: Iterable[str]) -> list[int]:
    """Return the numbers of those names that are ports."""
    return sorted(int(name.removeprefix(_PORT)) for name in names if name.startswith(_PORT))


def lock_of_port(name: str) -> int | None:
    """Return the number of the port whose lock has this name; None if it is no such lock."""
    match = _LOCK.fullmatch(name)
    if match is None or not match[1].startswith(_PORT):
        return None
    return int(match[1].removeprefix(_PORT))


def sweep(segments: Iterable[str], folder: Path = SHARED_MEMORY) -> list[str]:
    """Remove those of these segments that nobody has locked any more; return their names."""
    return [name for name in segments if _remove(folder / name)]


def is_users_alone(descriptor: int) -> bool:
    """Whether an open file is a regular file of this user without other hard links."""
    found = os.fstat(descriptor)
    return stat.S_ISREG(found.st_mode) and found.st_uid == os.geteuid() and found.st_nlink == 1


def _remove(segment: Path) -> bool:
    lock = segment.with_name(f"{segment.name}_el")
    try:
        descriptor = os.open(lock, _READ)
    except OSError:
        return False
    try:
        if not (is_users_alone(descriptor) and os.fstat(descriptor).st_size == 0):
            return False
        if not _is_of_fast_dds(segment):
            return False
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        if not os.path.samestat(os.fstat(descriptor), lock.lstat()):
            return False  # Somebody has created it again in the meantime.
        segment.unlink(missing_ok=True)
        lock.unlink(missing_ok=True)
    except OSError:
        return False
    finally:
        os.close(descriptor)
    return True


def _is_of_fast_dds(segment: Path) -> bool:
    """Whether a segment or port is this user's and really what its name says, or is gone."""
    try:
        descriptor = os.open(segment, _READ)
    except FileNotFoundError:
        return True
    try:
        return is_users_alone(descriptor) and os.read(descriptor, 4) in STATES
    finally:
        os.close(descriptor)


def sweep_abandoned(folder: Path = SHARED_MEMORY) -> list[str]:
    """Remove the segments of all nodes that were killed; return their names.

    Ports stay: a participant that still talks to a dead node must not see another at its port.
    """
    locks = (match for name in names(folder) if (match := _LOCK.fullmatch(name)))
    segments = (match[1] for match in locks if not match[1].startswith(_PORT))
    return sweep((name for name in segments if age_s(folder / f"{name}_el") > _ABANDONED_S), folder)


def names(folder: Path) -> list[str]:
    """Return the names of everything in a folder, nothing if there is no such folder."""
    try:
        return os.listdir(folder)  # noqa: PTH208 - Path objects cost more than the rest
    except OSError:
        return []


def age_s(path: Path) -> float:
    """Return the time since a file was last written to, in s; 0 if there is no file."""
    try:
        return time.time() - path.lstat().st_mtime
    except OSError:
        return 0.0

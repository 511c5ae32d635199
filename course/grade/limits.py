"""How much what is graded may take, of whatever a machine has little of."""

from __future__ import annotations

import os
import resource
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from course.grade.leftovers import descendants
from launcher.processes.table import processes
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterable

FILE_BYTES = 256 << 20
"""Largest file that any of its processes can write, a recording included."""
ADDRESS_BYTES = 8 << 30
"""Most address space of one process. DDS and OpenCV take some 2 GB of it, and use little."""
MORE_PROCESSES = 512
"""How many processes and threads its user may have, beyond those there are (not for root)."""
DISK_BYTES = 512 << 20
MEMORY_BYTES = 3 << 30
PROCESSES = 150
"""Most of the folders it writes in, of the memory of all its processes, and of those."""


def limit_this_process(longest_s: float) -> None:
    """Limit this process and all that it starts, for good."""
    cpu_s = int(2 * longest_s) + 60
    for kind, most in (
        (resource.RLIMIT_CORE, 0),
        (resource.RLIMIT_FSIZE, FILE_BYTES),
        (resource.RLIMIT_AS, ADDRESS_BYTES),
        (resource.RLIMIT_CPU, cpu_s),
        (resource.RLIMIT_NPROC, _tasks_of_user() + MORE_PROCESSES),
    ):
        hard = resource.getrlimit(kind)[1]
        most = most if hard == resource.RLIM_INFINITY else min(most, hard)  # noqa: PLW2901
        resource.setrlimit(kind, (most, most))


def _tasks_of_user() -> int:
    """Count the threads of this user, which is what the kernel limits."""
    return sum(_tasks(process.pid) for process in processes())


def _tasks(pid: int) -> int:
    """Return how many threads a process has; none if it is another user's, or gone."""
    with suppress(OSError):
        if Path(f"/proc/{pid}").stat().st_uid == os.getuid():
            return len(os.listdir(f"/proc/{pid}/task"))  # noqa: PTH208
    return 0


@dataclass(frozen=True)
class Taken:
    """What is taken at the moment."""

    processes: int
    memory_bytes: int
    disk_bytes: int

    def excess(self) -> str:
        """Say which limit is exceeded; empty if none is."""
        if self.processes > PROCESSES:
            return say("it started more than {n} processes", n=PROCESSES)
        if self.memory_bytes > MEMORY_BYTES:
            return say("it took more than {gb} GB of memory", gb=MEMORY_BYTES >> 30)
        if self.disk_bytes > DISK_BYTES:
            return say("it wrote more than {mb} MB", mb=DISK_BYTES >> 20)
        return ""


def taken(pid: int, places: Iterable[Path]) -> Taken:
    """Return what a process, all that descend from it, and some folders take."""
    family = descendants(pid)
    return Taken(
        len(family),
        sum(_memory_bytes(one.pid) for one in family),
        sum(map(_disk_bytes, places)),
    )


def _memory_bytes(pid: int) -> int:
    """Return what a process has of its own: anonymous memory, not what it shares."""
    try:
        with open(f"/proc/{pid}/statm", "rb") as file:  # noqa: PTH123 - like all reads of /proc
            fields = file.read().split()
    except OSError:
        return 0
    return (int(fields[1]) - int(fields[2])) * os.sysconf("SC_PAGE_SIZE") if fields else 0


def _disk_bytes(folder: Path) -> int:
    paths = (Path(place, name) for place, _folders, names in os.walk(folder) for name in names)
    return sum(map(_file_bytes, paths))


def _file_bytes(path: Path) -> int:
    with suppress(OSError):
        return path.lstat().st_blocks * 512
    return 0

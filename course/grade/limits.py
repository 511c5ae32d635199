"""How much what is graded may take, of whatever a machine has little of."""

from __future__ import annotations

import os
import resource
import stat
import subprocess
from collections import defaultdict
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

import psutil

from text.sentences import say

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
IN_MEMORY_BYTES = 512 << 20
"""Most of each folder that is kept in memory, shared memory included: nobody counts those."""
FILES = 20_000
DEEPEST = 60
"""How many folders may be within each other: a longer path cannot be looked at."""


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
    found = 0
    for pid in psutil.pids():
        with suppress(OSError):
            if Path(f"/proc/{pid}").stat().st_uid == os.getuid():
                found += len(os.listdir(f"/proc/{pid}/task"))  # noqa: PTH208
    return found


class Taken:
    """What a process, all that descend from it, and some folders take at the moment; each file counts once."""

    def __init__(self, pid: int, places: Iterable[Path]) -> None:
        self._sizes: dict[tuple[int, int], int] = {}
        """By device and number."""
        self._unseen = ""
        """A folder that cannot be looked into."""
        family = [one.pid for one in descendants(pid)]
        for place in places:
            self._look_through(place)
        for one in family:
            self._add_removed(one)
        self.processes = len(family)
        # What is read from files does not count.
        self.memory_bytes = sum(_sum_of(f"/proc/{one}/status", "RssAnon", "RssShmem") for one in family)
        if self.memory_bytes > MEMORY_BYTES:
            # What they share counts once; takes longer (proc(5), Linux 5.4).
            self.memory_bytes = sum(_sum_of(f"/proc/{one}/smaps_rollup", "Pss_Anon", "Pss_Shmem") for one in family)
        self.disk_bytes = sum(self._sizes.values())

    def excess(self) -> str:
        """Say which limit is exceeded; empty if none is."""
        if self.processes > PROCESSES:
            return say("it started more than {n} processes", n=PROCESSES)
        if self.memory_bytes > MEMORY_BYTES:
            return say("it took more than {gb} GB of memory", gb=MEMORY_BYTES >> 30)
        if self.disk_bytes > DISK_BYTES:
            return say("it wrote more than {mb} MB", mb=DISK_BYTES >> 20)
        if len(self._sizes) > FILES:
            return say("it made more than {n} files", n=FILES)
        if self._unseen:
            return say("it made a folder that cannot be looked into: {folder}", folder=self._unseen[:200])
        return ""

    def _look_through(self, folder: Path) -> None:
        """Add all that is in a folder, as far as is allowed to be there."""
        waiting = [(str(folder), 0)]
        while waiting and len(self._sizes) <= FILES and not self._unseen:
            place, depth = waiting.pop()
            try:
                with os.scandir(place) as entries:
                    for entry in entries:
                        self._add(entry.stat(follow_symlinks=False))
                        if entry.is_dir(follow_symlinks=False):
                            waiting.append((entry.path, depth + 1))
            except (FileNotFoundError, NotADirectoryError):
                continue
            except OSError:
                self._unseen = place
            if depth > DEEPEST:
                self._unseen = place

    def _add_removed(self, pid: int) -> None:
        """Add the files that a process has open and that are in no folder any more."""
        try:
            opened = os.listdir(f"/proc/{pid}/fd")  # noqa: PTH208
        except OSError:
            return
        for number in opened:
            with suppress(OSError):
                seen = os.stat(f"/proc/{pid}/fd/{number}")  # noqa: PTH116
                if stat.S_ISREG(seen.st_mode) and seen.st_nlink == 0:
                    self._add(seen)

    def _add(self, seen: os.stat_result) -> None:
        self._sizes[seen.st_dev, seen.st_ino] = seen.st_blocks * 512


def descendants(pid: int) -> list[psutil.Process]:
    """Return the living processes that descend from one, without that one.

    Not by `psutil.Process.children`, which gives up where /proc keeps others' processes to itself (hidepid=1).
    """
    children: defaultdict[int, list[psutil.Process]] = defaultdict(list)
    for each in psutil.process_iter(["ppid"]):
        children[each.info["ppid"]].append(each)
    parents, found = [pid], list[psutil.Process]()
    for parent in parents:
        born = children.pop(parent, [])
        parents += [each.pid for each in born]
        found += filter(_lives, born)
    return found


def _lives(process: psutil.Process) -> bool:
    """Whether it has not ended; one whose first thread alone has ended looks so, but for its threads."""
    try:
        return process.status() != psutil.STATUS_ZOMBIE or process.num_threads() > 1
    except psutil.Error:
        return False


def _sum_of(path: str, *names: str) -> int:
    """Add fields of a file in /proc, which are in kB; 0 of a process that is gone."""
    try:
        with open(path, encoding="utf-8", errors="replace") as file:  # noqa: PTH123 - as all of /proc
            fields = dict(line.split(":", 1) for line in file if ":" in line)
        return sum(int(fields[name].split()[0]) << 10 for name in names if name in fields)
    except (OSError, ValueError):
        return 0


def remove_tree(root: Path) -> None:
    """Remove a folder and all in it, nested as deep and closed as it may be; nobody may work in it any more.

    `shutil.rmtree` calls itself for each folder, and gives up at those that may not be read.
    """
    closed = ("-type", "d", "!", "-perm", "-700", "-execdir", "chmod", "700", "{}", ";")
    # With the current folder on the search path `find` would refuse.
    environ = {**os.environ, "PATH": os.defpath}
    for command in (("find", str(root), *closed), ("rm", "-rf", "--", str(root))):
        with suppress(OSError):
            subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environ, check=False)

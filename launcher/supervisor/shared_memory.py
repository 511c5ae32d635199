"""Clears shared memory of what would make nodes hang, and reports what was removed."""

from __future__ import annotations

import contextlib
import os
from typing import TYPE_CHECKING

from launcher.processes.shared_memory import SHARED_MEMORY
from launcher.processes.shared_memory_held import release_held, release_locks
from launcher.processes.shared_memory_unfinished import discard_unfinished
from launcher.status import Severity
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from text.sentences import Words


LEAST_FREE_BYTES = 1 << 20
"""Least free space; a Fast DDS participant takes half of it."""


class SharedMemory:
    """Cleared before nodes start and periodically afterwards: others may be killed at any time."""

    def __init__(self, tell: Callable[[Severity, Words], None], folder: Path = SHARED_MEMORY) -> None:
        """`tell` adds a line to the log."""
        self._tell = tell
        self._folder = folder
        self._kept: set[str] = set()
        self._full = False

    def clear(self) -> None:
        """Remove incomplete files; report once the problems that cannot be fixed here."""
        self._look_for_room()
        release_held(self._folder)
        found = discard_unfinished(self._folder)
        if found.removed:
            words = say(
                "removed {files} from /dev/shm: incomplete, left by a process that was killed; "
                "any node that opens it hangs",
                files=", ".join(found.removed),
            )
            self._tell(Severity.WARN, words)
        for name in found.kept:
            if name not in self._kept:
                self._kept.add(name)
                words = say(
                    "/dev/shm/{file} is incomplete, left by another user's process that was "
                    "killed; any node that opens it hangs: sudo rm /dev/shm/{file}",
                    file=name,
                )
                self._tell(Severity.ERROR, words)

    def release(self) -> None:
        """Open the locks that cannot wait for the next clearing."""
        release_locks(self._folder)

    def _look_for_room(self) -> None:
        with contextlib.suppress(OSError):
            room = os.statvfs(self._folder)
            full = room.f_bavail * room.f_frsize < LEAST_FREE_BYTES
            if full and not self._full:
                words = say(
                    "{folder} is full: nodes that start now may not hear the others; `df {folder}`"
                    " and `ls -l {folder}` show what fills it",
                    folder=self._folder,
                )
                self._tell(Severity.ERROR, words)
            self._full = full

"""The free disk space during a recording: how fast it shrinks, and when to stop."""

from __future__ import annotations

import os
from collections import deque
from typing import TYPE_CHECKING

from graph.bag.errors import BagError
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from text.sentences import Words

RESERVE_BYTES = 500_000_000
"""Kept free: what waits in memory must still fit, and a system with a full disk fails elsewhere."""
WINDOW_S = 5.0
"""Time over which the rate is measured."""
MEGA = 1e6


def free_bytes(folder: Path) -> int:
    """Return how many bytes an ordinary user may still write where this folder is, or will be."""
    while not folder.exists() and folder != folder.parent:
        folder = folder.parent
    found = os.statvfs(folder)
    return found.f_bavail * found.f_frsize


class DiskRoom:
    """Watches a folder's disk during a recording."""

    def __init__(
        self, folder: Path, reserve_bytes: int = RESERVE_BYTES, free: Callable[[Path], int] | None = None
    ) -> None:
        """`free` returns how many bytes are free at a folder; by default it asks the system.

        It may raise OSError.
        """
        self.bytes_per_s = 0.0
        """How fast the recording grows, over the last seconds."""
        self.left_s: float | None = None
        """How long it may still continue at this rate; None if unknown."""
        self.end: Words | None = None
        """Why the recording must stop now."""
        self._folder = folder
        self._reserve_bytes = reserve_bytes
        self._free = free or free_bytes
        self._seen: deque[tuple[float, int]] = deque()

    def check(self) -> None:
        """Raise BagError if there is no room to begin with."""
        try:
            free = self._free(self._folder)
        except OSError:
            return  # Creating the folder will give a better error.
        if free <= self._reserve_bytes:
            raise BagError(
                say(
                    "{path}: {free} MB are free on this disk, and {reserve} MB must stay free: "
                    "free some space, or record into a folder on another disk",
                    path=self._folder,
                    free=round(free / MEGA),
                    reserve=round(self._reserve_bytes / MEGA),
                )
            )

    def look(self, now_s: float, written_bytes: int) -> None:
        """Note how much has been recorded by now, and how much is free."""
        self._seen.append((now_s, written_bytes))
        while len(self._seen) > 2 and self._seen[1][0] <= now_s - WINDOW_S:
            self._seen.popleft()
        then_s, then_bytes = self._seen[0]
        if now_s > then_s:
            self.bytes_per_s = (written_bytes - then_bytes) / (now_s - then_s)
        try:
            free = self._free(self._folder)
        except OSError:
            self.left_s = None
            return
        spare = free - self._reserve_bytes
        self.left_s = max(0.0, spare / self.bytes_per_s) if self.bytes_per_s > 0 else None
        if spare <= 0:
            self.end = say(
                "recording has stopped: {free} MB are free on the disk of {path}. Everything "
                "recorded so far is intact. Free some space and record again",
                free=round(free / MEGA),
                path=self._folder,
            )

"""Whether a node that has just started may have missed a latched word of somebody it has not found.

Discovery takes tenths of a second, now and then seconds, and a latched word comes a little after
it; the command of another may come first. What was commanded already when the node started is to
be told from what is commanded later: its first message is among the first things that are heard.
"""

from __future__ import annotations

import time

_WATCH_S = 5.0
"""Who is heard for the first time later than this after the start came later too."""


class FirstHeard:
    """Watches who is heard for the first time after the start."""

    def __init__(self) -> None:
        self._started_s = self._newest_s = time.monotonic()
        self._known: set[str] = set()

    def hear(self, name: str) -> None:
        """Somebody says something, perhaps not for the first time."""
        now_s = time.monotonic()
        if name not in self._known and now_s - self._started_s < _WATCH_S:
            self._newest_s = now_s
        self._known.add(name)

    @property
    def quiet_s(self) -> float:
        """Seconds since the start, or since the last one arrived."""
        return time.monotonic() - self._newest_s

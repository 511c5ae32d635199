"""Whether a node that has just started may have missed a latched message of an undiscovered node.

Discovery takes tenths of a second, sometimes seconds, and a latched message arrives a little later;
the command of another node may come first. A source that was already sending when the node started
is recognised by its first message, which is among the first messages received.
"""

from __future__ import annotations

import time

_WATCH_S = 5.0
"""A source first heard later than this after the start was also started later."""


class FirstHeard:
    """Watches which sources are heard for the first time after the start."""

    def __init__(self) -> None:
        self._started_s = self._newest_s = time.monotonic()
        self._known: set[str] = set()

    def hear(self, name: str) -> None:
        """Note a message of this source, perhaps not its first."""
        now_s = time.monotonic()
        if name not in self._known and now_s - self._started_s < _WATCH_S:
            self._newest_s = now_s
        self._known.add(name)

    @property
    def quiet_s(self) -> float:
        """Return the seconds since the start, or since the last new source."""
        return time.monotonic() - self._newest_s

"""Whether this process was held up, so that what waits in its queues may be older than it looks.

A process that was stopped, or starved, for seconds finds commands and readings in its queues that
it would take for new ones. The stamps of messages are no help: clocks of two machines differ.
"""

from __future__ import annotations

import time

_DRAIN_S = 0.1
"""How long it takes to get rid of what has waited."""


class Nap:
    """To be asked in every callback, and by a timer: the time between two is the time asleep."""

    def __init__(self) -> None:
        self._last_s = time.monotonic()
        self._deaf_until_s = self._last_s

    def lasted(self, longest_s: float) -> bool:
        """Whether to take nothing in now, having just slept for more than `longest_s`."""
        now_s = time.monotonic()
        if now_s - self._last_s > longest_s:
            self._deaf_until_s = now_s + _DRAIN_S
        self._last_s = now_s
        return now_s < self._deaf_until_s

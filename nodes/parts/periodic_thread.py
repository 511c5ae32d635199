"""Calls a function at a fixed rate on its own thread, which costs less than a node's timer.

Each round of an executor checks everything a node waits for; at 50 Hz that is most of its work.
"""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable


class PeriodicThread:
    """Calls back every `period_s` seconds, which may be changed at any time."""

    def __init__(self, period_s: float, call: Callable[[], None]) -> None:
        self.period_s = period_s
        self._call = call
        self._ending = False
        self._thread = threading.Thread(target=self._live, name="pace", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def close(self) -> None:
        """End the thread, after its current callback."""
        self._ending = True
        if self._thread.is_alive():
            self._thread.join(2 * self.period_s + 0.1)

    def _live(self) -> None:
        due_s = time.monotonic()
        while not self._ending:
            self._call()
            # Missed calls are not made up for.
            due_s = max(due_s + self.period_s, time.monotonic())
            time.sleep(max(0.0, due_s - time.monotonic()))

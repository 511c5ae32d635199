"""Detects that this process was stopped, so that keys may be older than their timestamps.

A key gets its timestamp when it is read from the terminal. Keys typed while the process was stopped
are read when it continues, and look as if they had just been pressed. So for a moment after such a
stall timestamps are not trusted. A separate thread checks this, because an event loop that is
merely busy does not delay timestamps.
"""

from __future__ import annotations

import math
import threading

from tui import clock

LOOK_S = 0.1
LONGEST_S = 0.6
"""Longest time between two checks: a busy machine may delay everything by nearly half a second."""
DRAIN_S = 0.5
"""How long it takes to read waiting keys on a busy machine."""


class KeyStallDetector:
    """Checks the clock all the time; a long time between two checks was a stall."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._last_s = clock.steady()
        self.woke_s = -math.inf
        """When the last stall was noticed, on the monotonic clock."""
        self._over = threading.Event()

    def watch(self) -> None:
        self._last_s = clock.steady()
        threading.Thread(target=self._run, name="stall-detector", daemon=True).start()

    def end(self) -> None:
        self._over.set()

    def may_precede(self, at_s: float) -> bool:
        """Whether a key with this timestamp may have been typed before the end of a stall."""
        # After a stall the key may be processed before the thread gets to run.
        self._look()
        return at_s < self.woke_s + DRAIN_S

    def _run(self) -> None:
        while not self._over.wait(LOOK_S):
            self._look()

    def _look(self) -> None:
        with self._lock:
            now_s = clock.steady()
            if now_s - self._last_s > LONGEST_S:
                self.woke_s = now_s
            self._last_s = now_s

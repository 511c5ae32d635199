"""Whether this process was held up, so that keys may have waited longer than their stamps tell.

A key is stamped when it is read from the terminal. What was typed while the process was stopped is
read when it goes on, and looks as if it had just been pressed. So for a moment after such a stall
no stamp is believed. A thread of its own looks, for an event loop that is merely busy delays no
stamp.
"""

from __future__ import annotations

import math
import threading

from tui import clock

LOOK_S = 0.1
LONGEST_S = 0.6
"""Between two looks: a machine that is busy may hold everything up for nearly half a second."""
DRAIN_S = 0.5
"""How long it takes to read what has waited, on a machine that is busy besides."""


class KeyStallDetector:
    """Looks at the clock all the time; a long time between two looks was a stall."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._last_s = clock.steady()
        self.woke_s = -math.inf
        """When the newest stall was noticed, on the steady clock."""
        self._over = threading.Event()

    def watch(self) -> None:
        """Look from now on."""
        self._last_s = clock.steady()
        threading.Thread(target=self._run, name="stall-detector", daemon=True).start()

    def end(self) -> None:
        """Look no more."""
        self._over.set()

    def may_precede(self, at_s: float) -> bool:
        """Whether a key with this stamp may have been typed before the process woke."""
        # After a stall the key may be here before the thread has had its turn.
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

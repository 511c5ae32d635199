"""Whether the observer's process lives: signs of life, and how long none has come."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

OLD_AFTER_S = 3.0
"""Without a sign for so long, what is known of the graph is old; one is due each second."""
HUNG_AFTER_S = 8.0
"""A process that could run and has given no sign for so long hangs."""
GIVEN_UP_AFTER_S = 60.0
"""No machine is so busy that a process does not get to it within this."""
LOOK_S = 0.5
"""How often to look."""
SKIPPED_S = 2.0
"""Whoever looks so much later than it meant to was held up itself, and with it perhaps all."""


class Vigil:
    """Watches over one process; times are on the monotonic clock."""

    def __init__(self, now_s: float) -> None:
        """Begin: it has just been started."""
        self._sign_s = self._looked_s = now_s
        self._excused_s = 0.0

    def sign(self, now_s: float) -> None:
        self._sign_s = self._looked_s = now_s
        self._excused_s = 0.0

    def old_since_s(self, now_s: float) -> float | None:
        """Return when the last sign came, if that is long ago."""
        return self._sign_s if now_s - self._sign_s > OLD_AFTER_S else None

    def hangs(self, now_s: float, is_ready_to_run: Callable[[], bool]) -> bool:
        """Look; return whether it hangs. Times in which it only lacked a processor do not count."""
        passed_s, self._looked_s = now_s - self._looked_s, now_s
        silent_s = now_s - self._sign_s
        if silent_s > GIVEN_UP_AFTER_S:
            return True
        if silent_s > OLD_AFTER_S and (passed_s > SKIPPED_S or is_ready_to_run()):
            self._excused_s += passed_s
        return silent_s - self._excused_s > HUNG_AFTER_S

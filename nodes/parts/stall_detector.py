"""Detects whether this process was held up, so that waiting messages may be older than they seem.

A process that was suspended or starved for seconds finds commands and readings in its queues that
seem new: a drive command whose stop waits behind it. So it ignores all messages for a moment. A
machine under load may need longer than that to deliver what has waited; then the stamp of a message
shows its age, if it has one. Clocks of two machines differ, so stamps are checked only for the
first seconds.
"""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from builtin_interfaces.msg import Time

_DRAIN_S = 0.5
"""How long it takes to deliver what has waited, on a machine that is also busy."""
_DRAIN_UNDER_LOAD_S = 3.0
_ANOTHER_CLOCK_S = 30.0
"""A greater difference comes from the clocks, and does not show how long it waited."""


class StallDetector:
    """Ask it in every callback and from a timer: the time between two calls is the time asleep."""

    def __init__(self) -> None:
        self._last_s = time.monotonic()
        self._woke_s = -math.inf

    def lasted(self, longest_s: float) -> bool:
        """Return whether to ignore messages now, after a sleep of more than `longest_s`."""
        now_s = time.monotonic()
        if now_s - self._last_s > longest_s:
            self._woke_s = now_s
        self._last_s = now_s
        return now_s - self._woke_s < _DRAIN_S

    def kept_waiting(self, stamp: Time) -> bool:
        """Return whether a message with this stamp was sent while this process slept."""
        awake_s = time.monotonic() - self._woke_s
        if awake_s > _DRAIN_UNDER_LOAD_S or not (stamp.sec or stamp.nanosec):
            return False
        age_s = time.time() - stamp.sec - stamp.nanosec * 1e-9
        return bool(awake_s < age_s < _ANOTHER_CLOCK_S)

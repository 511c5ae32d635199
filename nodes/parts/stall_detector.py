"""Whether this process was held up, so that what waits in its queues may be older than it looks.

A process that was stopped, or starved, for seconds finds commands and readings in its queues that
it would take for new ones: a command to drive whose stop waits behind it. For a moment it takes
nothing in. A machine under load may take longer than that to hand over what has waited; then the
stamp of a message tells, if it has one. Clocks of two machines differ, so stamps are asked only
for the first seconds.
"""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from builtin_interfaces.msg import Time

_DRAIN_S = 0.5
"""How long it takes to get rid of what has waited, on a machine that is busy besides."""
_DRAIN_UNDER_LOAD_S = 3.0
_ANOTHER_CLOCK_S = 30.0
"""A difference of more than that is one of clocks, and tells nothing of how long it waited."""


class StallDetector:
    """To be asked in every callback, and by a timer: the time between two is the time asleep."""

    def __init__(self) -> None:
        self._last_s = time.monotonic()
        self._woke_s = -math.inf

    def lasted(self, longest_s: float) -> bool:
        """Whether to take nothing in now, having just slept for more than `longest_s`."""
        now_s = time.monotonic()
        if now_s - self._last_s > longest_s:
            self._woke_s = now_s
        self._last_s = now_s
        return now_s - self._woke_s < _DRAIN_S

    def kept_waiting(self, stamp: Time) -> bool:
        """Whether a message of this stamp was sent while this process slept."""
        awake_s = time.monotonic() - self._woke_s
        if awake_s > _DRAIN_UNDER_LOAD_S or not (stamp.sec or stamp.nanosec):
            return False
        age_s = time.time() - stamp.sec - stamp.nanosec * 1e-9
        return bool(awake_s < age_s < _ANOTHER_CLOCK_S)

"""The clocks that the screen reads, so that tests can stop them."""

from __future__ import annotations

import time


def now() -> float:
    """Return unix time in seconds."""
    return time.time()


def time_of_day(time_s: float) -> str:
    """Return the local time of a unix time, dashes for one that is in no year of a calendar."""
    try:
        return time.strftime("%H:%M:%S", time.localtime(time_s))
    except (OverflowError, ValueError, OSError):
        return "--:--:--"


def steady() -> float:
    """Return the monotonic clock in seconds, the one that keys are stamped with."""
    return time.monotonic()

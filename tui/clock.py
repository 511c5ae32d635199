"""The clocks that the screen reads, so that tests can stop them."""

from __future__ import annotations

import time


def now() -> float:
    """Return Unix time in seconds."""
    return time.time()


def time_of_day(time_s: float) -> str:
    """Return the local time of a Unix time, or dashes if it is outside the calendar."""
    try:
        return time.strftime("%H:%M:%S", time.localtime(time_s))
    except (OverflowError, ValueError, OSError):
        return "--:--:--"


def steady() -> float:
    """Return the monotonic clock in seconds, the one used for key timestamps."""
    return time.monotonic()

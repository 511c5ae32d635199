"""The clocks that the screen reads, so that tests can stop them."""

from __future__ import annotations

import time


def now() -> float:
    """Return unix time in seconds."""
    return time.time()


def steady() -> float:
    """Return the monotonic clock in seconds, the one that keys are stamped with."""
    return time.monotonic()

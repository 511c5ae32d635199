"""The one clock that the screen reads for what it shows, so that tests can stop it."""

from __future__ import annotations

import time


def now() -> float:
    """Return unix time in seconds."""
    return time.time()

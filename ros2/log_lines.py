"""Lines of a log, as a node of a program in C++ writes them to its standard error."""

from __future__ import annotations

import sys
import time


def log(logger: str, words: str, severity: str = "INFO") -> None:
    """Write a line of the log as ros2 does."""
    print(f"[{severity}] [{time.time():.9f}] [{logger}]: {words}", file=sys.stderr, flush=True)

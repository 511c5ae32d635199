"""How slow the machine is now, so that no deadline of a test is a bet on it.

The process that hands out the tests does a fixed piece of work at its start and once a minute, and
writes down how much longer that took than on the machine the deadlines were written for. It counts
the wall time: a machine whose processors are shared is slow, too. Deadlines are multiplied by it.
"""

from __future__ import annotations

import contextlib
import os
import threading
import time
from pathlib import Path

FILE = "TESTS_SLOWNESS"
"""The variable that names the file; a child of a test reads it, too."""
EVERY_S = 60.0
_WORK = 2_000_000
_QUIET_S = 0.09
"""How long the work takes on two quiet cores of 2026, with Python 3.11."""


def slowness() -> float:
    """Return how many times longer than on the quiet machine a thing takes now; at least 1."""
    with contextlib.suppress(KeyError, OSError, ValueError):
        return max(1.0, float(Path(os.environ[FILE]).read_text(encoding="ascii")))
    return 1.0


def patient(seconds: float) -> float:
    """Return how long to wait here for what takes at most `seconds` on the quiet machine."""
    return seconds * slowness()


def measure() -> float:
    """Do the work; return its time by that of the quiet machine."""
    began_s = time.perf_counter()
    sum(number * number % 7 for number in range(_WORK))
    return (time.perf_counter() - began_s) / _QUIET_S


def keep_measured(path: Path) -> None:
    """Write it down now, and from time to time from now on, for this process and its children."""
    os.environ[FILE] = str(path)
    _write(path)
    threading.Thread(target=_go_on, args=[path], daemon=True).start()


def _go_on(path: Path) -> None:
    # The run removes the folder at its end.
    with contextlib.suppress(OSError):
        while True:
            time.sleep(EVERY_S)
            _write(path)


def _write(path: Path) -> None:
    fresh = path.with_suffix(".new")
    fresh.write_text(f"{measure():.2f}", encoding="ascii")
    fresh.replace(path)

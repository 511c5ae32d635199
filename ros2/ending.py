"""Ending on a signal, as the real programs do; and lines of a log, as a node in C++ writes them."""

from __future__ import annotations

import signal
import sys
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING

from launcher.processes.ending import ENDING

if TYPE_CHECKING:
    from collections.abc import Iterator


@contextmanager
def until_interrupted() -> Iterator[None]:
    """Let a signal end a `with` in order and without an error.

    SIGINT too where a shell has it ignored, as it has for what runs in its background. Who waits for an event in it
    takes `stop_by_signals` instead: the signal would find the event's lock let go of.
    """

    def interrupt(_number: int, _frame: object) -> None:
        raise KeyboardInterrupt

    before = {number: signal.signal(number, interrupt) for number in ENDING}
    try:
        yield
    except KeyboardInterrupt:
        pass
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def was_interrupted(error: BaseException) -> bool:
    """Whether it only comes of a signal: rclpy fails to convert what it is just converting."""
    cause: BaseException | None = error
    while cause is not None and not isinstance(cause, KeyboardInterrupt):
        cause = cause.__cause__ or cause.__context__
    return cause is not None


def log(logger: str, words: str, severity: str = "INFO") -> None:
    """Write a line of the log as ros2 does."""
    print(f"[{severity}] [{time.time():.9f}] [{logger}]: {words}", file=sys.stderr, flush=True)

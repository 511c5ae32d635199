"""The end of a command by a signal, for one whose own thread waits."""

from __future__ import annotations

import signal
import threading
from queue import SimpleQueue

ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
"""What asks a command to end."""


def stop_by_signals() -> threading.Event:
    """Return an event that any of these signals sets; call it on the main thread.

    A handler that set it itself would wait for ever: it interrupts the main thread, which may hold
    the lock of that very event. `SimpleQueue.put` may be called anywhere (documentation of queue).
    """
    stop = threading.Event()
    came: SimpleQueue[int] = SimpleQueue()

    def await_one() -> None:
        came.get()
        stop.set()

    threading.Thread(target=await_one, name="ending", daemon=True).start()
    for number in ENDING:
        signal.signal(number, lambda number, _frame: came.put(number))
    return stop

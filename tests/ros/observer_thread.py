"""What the observer's process does, on a thread of the test's: there it can be looked into.

It is as quick as the test's own imports, and what a test patches holds for it, too.
"""

from __future__ import annotations

import os
import socket
import subprocess
import threading
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from typing import Any, cast

from graph.observer.observer import ObserverProcess
from graph.observer.process import ObserverLoop


class _Thread:
    """As much of `subprocess.Popen` as is asked of it."""

    pid = os.getpid()

    def __init__(self, end: Connection) -> None:
        self._end = end
        self._thread = threading.Thread(target=self._run, name="observer", daemon=True)
        self._thread.start()

    def poll(self) -> int | None:
        return None if self._thread.is_alive() else 0

    def wait(self, timeout: float | None = None) -> int:
        self._thread.join(timeout)
        if self._thread.is_alive():
            raise subprocess.TimeoutExpired("observer", timeout or 0.0)
        return 0

    def _run(self) -> None:
        try:
            ObserverLoop(self._end).run()
        finally:
            # Whoever listens at either end hears of it.
            with socket.socket(fileno=os.dup(self._end.fileno())) as end:
                end.shutdown(socket.SHUT_RDWR)


class ObserverThread(ObserverProcess):
    """It can be started and ended like a process, but not killed."""

    def __init__(self) -> None:
        ours, theirs = Pipe()
        self._process = cast("Any", _Thread(theirs))
        self._begin(ours, {})

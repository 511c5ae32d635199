"""What the observer's process does, on a thread of the test's: there it can be looked into.

It is as quick as the test's own imports, and what a test patches holds for it, too.
"""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import threading
from typing import Any, cast

from graph.observer.process import language
from graph.observer.process.serving import Server
from graph.observer.process.started import ObserverProcess
from graph.observer.process.wire import Wire


class _Thread:
    """As much of `subprocess.Popen` as is asked of it."""

    pid = os.getpid()

    def __init__(self, wire: Wire) -> None:
        self._wire = wire
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
            Server(self._wire).run()
        finally:
            self._wire.close()


class ObserverThread(ObserverProcess):
    """It can be started and ended like a process, but not killed."""

    def __init__(self) -> None:
        ours, theirs = socket.socketpair()
        self._streams: dict[int, int] = {}
        self._process = cast("Any", _Thread(Wire(theirs)))
        self.wire = Wire(ours)
        self.send((0, language.PATH, tuple(sys.path), 0.0))

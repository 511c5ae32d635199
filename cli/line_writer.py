"""Standard output for a run that must not block: written on a thread, as its reader may stall."""

from __future__ import annotations

import os
import select
import threading
from collections import deque
from collections.abc import Callable

from text.output import harmless

MOST_WAITING = 8_000_000
"""Most bytes that wait for the reader; lines beyond that are left out and counted."""


class LineWriter:
    """Writes lines to a descriptor, in order, without ever blocking the caller."""

    def __init__(
        self, fd: int, encoding: str, *, left_out: Callable[[int], str], on_gone: Callable[[], object]
    ) -> None:
        """Begin.

        Args:
            fd: the descriptor to write to
            encoding: of the lines; characters that it lacks are replaced
            left_out: returns the line that tells how many lines were left out
            on_gone: called once, on another thread, when the reader is gone
        """
        self._fd = fd
        self._encoding = encoding
        self._left_out_line = left_out
        self._on_gone = on_gone
        self._lock = threading.Condition()
        self._waiting: deque[bytes] = deque()
        self._size = 0
        self._left_out = 0
        self._busy = False
        self.gone = False
        """Whether writing is no longer possible."""
        threading.Thread(target=self._run, name="output", daemon=True).start()

    def write(self, line: str) -> None:
        with self._lock:
            if self.gone:
                return
            if self._size > MOST_WAITING:
                self._left_out += 1
                return
            if self._left_out:
                self._append(self._left_out_line(self._left_out))
                self._left_out = 0
            self._append(line)
            self._lock.notify_all()

    def finish(self, within_s: float = 5.0) -> None:
        """Wait until everything is written, up to a time limit."""
        with self._lock:
            self._lock.wait_for(lambda: self.gone or not (self._waiting or self._busy), timeout=within_s)

    def _append(self, line: str) -> None:
        data = (harmless(line) + "\n").encode(self._encoding, "replace")
        self._waiting.append(data)
        self._size += len(data)

    def _run(self) -> None:
        while not self.gone:
            with self._lock:
                self._lock.wait_for(lambda: self._waiting)
                data = b"".join(self._waiting)
                self._waiting.clear()
                self._busy = True
            gone = not self._put(data)
            with self._lock:
                self._busy = False
                self._size -= len(data)
                self.gone = gone
                self._lock.notify_all()
            if gone:
                self._on_gone()

    def _put(self, data: bytes) -> bool:
        view = memoryview(data)
        while view:
            try:
                view = view[os.write(self._fd, view[:65536]) :]
            except BlockingIOError:  # noqa: PERF203 - the descriptor may be shared
                select.select([], [self._fd], [], 1.0)
            except OSError:
                return False
        return True

"""What is written to the terminal: through a thread of its own, so that nobody waits for it."""

from __future__ import annotations

import fcntl
import os
import select
import struct
import termios
import threading
from collections import deque
from typing import TYPE_CHECKING

from tui.terminal.bandwidth import Bandwidth
from tui.terminal.terminal_diff import TerminalDiff

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from tui.terminal.pixels import PixelPicture

MOST_WAITING = 1_000_000
"""Bytes that may wait for the terminal; with more it counts as stalled."""
LAST_WORDS_S = 1.0
"""How long exiting waits for a terminal that takes no output."""


class Terminal:
    """A file to which Textual can write without ever blocking.

    When the terminal takes nothing, waiting and further output is dropped until it takes output
    again: then `on_caught_up` is called, on another thread, for a full repaint.
    """

    def __init__(
        self,
        fd: int,
        on_caught_up: Callable[[], object],
        bandwidth: Bandwidth | None = None,
        pictures: Mapping[str, PixelPicture] | None = None,
    ) -> None:
        """Write to `fd` on a separate thread, and report all output to `bandwidth`."""
        self._fd = fd
        self._bandwidth = bandwidth or Bandwidth()
        self._diff = TerminalDiff(pictures)
        self._terminal_size = (0, 0)
        self._on_caught_up = on_caught_up
        self._lock = threading.Condition()
        self._waiting: deque[bytes] = deque()
        self._size = 0
        self._busy = False
        self._stalled = False
        self._has_dropped = False
        """Whether output was dropped since the last that was written: pictures may have stayed."""
        self.gone = False
        """Whether writing to it has become impossible."""
        self.leaving = False
        """Once set, nothing is dropped any more: the state of the terminal must be restored."""
        threading.Thread(target=self._run, name="terminal-output", daemon=True).start()

    def write(self, text: str) -> None:
        """Queue `text` for writing; it is dropped if the terminal is stalled."""
        with self._lock:
            if self.gone or (self._stalled and not self.leaving):
                return
            left = self._diff.erase_all if self._has_dropped else ""
            self._has_dropped = False
            data = (left + self._changes(text)).encode("utf-8", "replace")
            self._waiting.append(data)
            self._size += len(data)
            self._bandwidth.written(len(data))
            self._bandwidth.behind = True
            if self._size > MOST_WAITING:
                self._stalled = self._has_dropped = True
                self._terminal_size = (0, 0)
                self._waiting.clear()
                self._size = 0
            self._lock.notify_all()

    def _changes(self, text: str) -> str:
        size = self.size()
        if size != self._terminal_size:
            self._terminal_size = size
            self._diff.forget(*size)
        return self._diff.changes(text)

    def forget(self) -> None:
        """Assume nothing about what the terminal shows: another program may have written to it."""
        with self._lock:
            self._terminal_size = (0, 0)

    def size(self) -> tuple[int, int]:
        """Return columns and lines, or default values if the terminal does not report them."""
        try:
            columns, lines = os.get_terminal_size(self._fd)
        except OSError:
            return 80, 24
        return columns or 80, lines or 24

    def cell(self) -> tuple[int, int]:
        """Return width and height of a cell in pixels as the system knows them, else zeros."""
        try:
            rows, columns, width, height = struct.unpack("4H", fcntl.ioctl(self._fd, termios.TIOCGWINSZ, bytes(8)))
        except OSError:
            return 0, 0
        return width // max(1, columns), height // max(1, rows)

    def flush(self) -> None:
        """Do nothing: output is already on its way."""

    def isatty(self) -> bool:
        return True

    def fileno(self) -> int:
        return self._fd

    def finish(self) -> None:
        """Wait until everything has been written, for a limited time."""
        with self._lock:
            self._lock.wait_for(lambda: self.gone or not (self._waiting or self._busy), LAST_WORDS_S)

    def _run(self) -> None:
        while not self.gone:
            with self._lock:
                self._lock.wait_for(lambda: self._waiting or self._stalled)
                data = b"".join(self._waiting)
                self._waiting.clear()
                self._size = 0
                self._busy = True
            self._put(data)
            with self._lock:
                self._busy = False
                self._bandwidth.behind = bool(self._waiting)
                caught_up, self._stalled = self._stalled, False
                self._lock.notify_all()
            if caught_up:
                self._on_caught_up()

    def _put(self, data: bytes) -> None:
        view = memoryview(data)
        try:
            while True:
                # Another program may have left the terminal in non-blocking mode.
                select.select([], [self._fd], [])
                view = view[os.write(self._fd, view[:4096]) :]
                if not view:
                    return
        except OSError:
            self.gone = True

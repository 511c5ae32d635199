"""The terminal as it really is: slow at times, and gone at others.

Textual writes to it through a short queue and waits when that is full, reads it in a thread that
spins at its end, and knows nothing of a hang-up. Here writing never waits, and a terminal that
has gone is told to the app.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import select
import signal
import threading
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING

from textual.drivers.linux_driver import LinuxDriver
from textual.events import Resize
from textual.geometry import Size

from tui.terminal.bandwidth import Bandwidth
from tui.terminal.terminal_diff import TerminalDiff

if TYPE_CHECKING:
    from textual.app import App

    class OnTerminal(App[int]):
        """An app that knows its terminal."""

        terminal_fd: int
        bandwidth: Bandwidth


MOST_WAITING = 1_000_000
"""Bytes that may wait for the terminal; beyond them it counts as stalled."""
LAST_WORDS_S = 1.0
"""How long leaving waits for a terminal that takes nothing."""


class Terminal:
    """A file for Textual to write to that never makes the writer wait.

    When the terminal takes nothing, what waits is dropped, and so is what comes, until it takes
    again: then `on_caught_up` is called, for a full repaint. It is called on another thread.
    """

    def __init__(
        self, fd: int, on_caught_up: Callable[[], object], bandwidth: Bandwidth | None = None
    ) -> None:
        """Write to `fd` on a thread of its own, and tell `bandwidth` of all that is written."""
        self._fd = fd
        self._bandwidth = bandwidth or Bandwidth()
        self._diff = TerminalDiff()
        self._terminal_size = (0, 0)
        self._on_caught_up = on_caught_up
        self._lock = threading.Condition()
        self._waiting: deque[bytes] = deque()
        self._size = 0
        self._busy = False
        self._stalled = False
        self.gone = False
        """Whether writing to it is no longer possible."""
        self.leaving = False
        """Set: nothing is dropped any more, the terminal must be left as it was found."""
        threading.Thread(target=self._run, name="terminal-output", daemon=True).start()

    def write(self, text: str) -> None:
        """Have `text` written some time, or never if the terminal is stalled."""
        with self._lock:
            if self.gone or (self._stalled and not self.leaving):
                return
            data = self._changes(text).encode("utf-8", "replace")
            self._waiting.append(data)
            self._size += len(data)
            self._bandwidth.written(len(data))
            self._bandwidth.behind = True
            if self._size > MOST_WAITING:
                self._stalled = True
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
        """Assume nothing of what the terminal shows: somebody else may have written to it."""
        with self._lock:
            self._terminal_size = (0, 0)

    def size(self) -> tuple[int, int]:
        """Return columns and lines, those of any terminal where it does not tell."""
        try:
            columns, lines = os.get_terminal_size(self._fd)
        except OSError:
            return 80, 24
        return columns or 80, lines or 24

    def flush(self) -> None:
        """Do nothing: what was written is on its way."""

    def isatty(self) -> bool:
        """Say that it is a terminal."""
        return True

    def fileno(self) -> int:
        """Return the descriptor."""
        return self._fd

    def finish(self) -> None:
        """Wait until all is out, but not for ever."""
        with self._lock:
            self._lock.wait_for(
                lambda: self.gone or not (self._waiting or self._busy), LAST_WORDS_S
            )

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
                # Another program may have left the terminal non-blocking.
                select.select([], [self._fd], [])
                view = view[os.write(self._fd, view[:4096]) :]
                if not view:
                    return
        except OSError:
            self.gone = True


class DeckDriver(LinuxDriver):
    """Textual's driver, on a terminal that may stall or go."""

    def __init__(self, app: OnTerminal, **options: bool | tuple[int, int] | None) -> None:
        """Write to the app's terminal: descriptors 1 and 2 may lead elsewhere."""
        super().__init__(app, **options)  # type: ignore[arg-type]
        fd = app.terminal_fd
        self._terminal = Terminal(
            fd, lambda: app.call_later(app.refresh, layout=True), app.bandwidth
        )
        self._file = self._terminal  # type: ignore[assignment]

    @property
    def gone(self) -> bool:
        """Whether the terminal has hung up."""
        return self._terminal.gone or _hung_up(self.fileno)

    def give_up(self) -> None:
        """Read no more: a terminal that has hung up is always ready to be read, and empty."""
        self.exit_event.set()

    def run_input_thread(self) -> None:
        """Read until the app ends or the terminal goes."""
        with contextlib.suppress(OSError):
            super().run_input_thread()

    def start_application_mode(self) -> None:
        """Take the terminal over, and tell the app of every size it gets, the last one last.

        Textual does that in a Python signal handler. A second signal may interrupt it when it has
        read a size and not yet told it; then the app is left with the size before the last.
        """
        super().start_application_mode()  # type: ignore[no-untyped-call]
        asyncio.get_running_loop().add_signal_handler(signal.SIGWINCH, self._tell_size)

    def _tell_size(self) -> None:
        # A terminal that tells of its size itself, in its output, says it but once.
        if not self._in_band_window_resize:
            size = Size(*self._get_terminal_size())
            self._app.post_message(Resize(size, size))

    def _get_terminal_size(self) -> tuple[int, int]:
        return self._terminal.size()

    def forget(self) -> None:
        """Send everything anew with the next frame."""
        self._terminal.forget()

    def stop_application_mode(self) -> None:
        """Leave the terminal as it was found, a stalled one too once it takes again."""
        self._terminal.leaving = True
        super().stop_application_mode()

    def close(self) -> None:
        """Let the last words out."""
        super().close()
        self._terminal.finish()


def _hung_up(fd: int) -> bool:
    poll = select.poll()
    poll.register(fd, 0)
    return bool(poll.poll(0))

"""The terminal as it really is: sometimes slow, and sometimes gone.

Textual writes to it through a short queue and blocks when that is full, reads it in a thread that
spins at the end of input, and ignores a hang-up. Here writing never blocks, and the app is notified
when the terminal has gone.
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

from textual.drivers import linux_driver
from textual.drivers.linux_driver import LinuxDriver
from textual.events import Resize
from textual.geometry import Size

from tui.terminal.alt_keys import AltKeyParser
from tui.terminal.bandwidth import Bandwidth
from tui.terminal.terminal_diff import TerminalDiff

if TYPE_CHECKING:
    from textual.app import App

    class OnTerminal(App[int]):
        """An app that has a terminal."""

        terminal_fd: int
        bandwidth: Bandwidth


# Textual has no other way to choose the parser.
linux_driver.XTermParser = AltKeyParser  # type: ignore[attr-defined]

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
        self, fd: int, on_caught_up: Callable[[], object], bandwidth: Bandwidth | None = None
    ) -> None:
        """Write to `fd` on a separate thread, and report all output to `bandwidth`."""
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
        """Whether writing to it has become impossible."""
        self.leaving = False
        """Once set, nothing is dropped any more: the state of the terminal must be restored."""
        threading.Thread(target=self._run, name="terminal-output", daemon=True).start()

    def write(self, text: str) -> None:
        """Queue `text` for writing; it is dropped if the terminal is stalled."""
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

    def flush(self) -> None:
        """Do nothing: output is already on its way."""

    def isatty(self) -> bool:
        """Return that it is a terminal."""
        return True

    def fileno(self) -> int:
        """Return the descriptor."""
        return self._fd

    def finish(self) -> None:
        """Wait until everything has been written, for a limited time."""
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
                # Another program may have left the terminal in non-blocking mode.
                select.select([], [self._fd], [])
                view = view[os.write(self._fd, view[:4096]) :]
                if not view:
                    return
        except OSError:
            self.gone = True


class DeckDriver(LinuxDriver):
    """Textual's driver for a terminal that may stall or disappear."""

    def __init__(self, app: OnTerminal, **options: bool | tuple[int, int] | None) -> None:
        """Write to the app's terminal: descriptors 1 and 2 may be redirected."""
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
        """Stop reading: a terminal that has hung up is always ready to be read, and empty."""
        self.exit_event.set()

    def run_input_thread(self) -> None:
        """Read until the app ends or the terminal is gone."""
        with contextlib.suppress(OSError):
            super().run_input_thread()

    def _sigcont_application(self, *_: object) -> None:
        """Take the terminal over again, also if SIGSTOP left no time to give it back.

        Textual would then read it in a second thread, and one of both would wait for a key after
        the other has read `q`.
        """
        if self._auto_restart and not self._must_signal_resume:
            self.suspend_application_mode()
            self._must_signal_resume = True
        super()._sigcont_application()

    def start_application_mode(self) -> None:
        """Set up the terminal, and report every change of its size to the app, the last one last.

        Textual does that in a Python signal handler. A second signal may interrupt it after it has
        read a size but before it has reported it; then the app keeps the second-to-last size.
        """
        super().start_application_mode()  # type: ignore[no-untyped-call]
        asyncio.get_running_loop().add_signal_handler(signal.SIGWINCH, self._tell_size)

    def _tell_size(self) -> None:
        # A terminal that reports its size itself, in-band, does so only once.
        if not self._in_band_window_resize:
            size = Size(*self._get_terminal_size())
            self._app.post_message(Resize(size, size))

    def _get_terminal_size(self) -> tuple[int, int]:
        return self._terminal.size()

    def forget(self) -> None:
        """Send everything again with the next frame."""
        self._terminal.forget()

    def stop_application_mode(self) -> None:
        """Restore the terminal, even a stalled one once it takes output again."""
        self._terminal.leaving = True
        super().stop_application_mode()

    def close(self) -> None:
        """Write the remaining output."""
        super().close()
        self._terminal.finish()


def _hung_up(fd: int) -> bool:
    poll = select.poll()
    poll.register(fd, 0)
    return bool(poll.poll(0))

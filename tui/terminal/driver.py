"""The terminal as it really is: sometimes slow, and sometimes gone.

Textual writes to it through a short queue and blocks when that is full, reads it in a thread that
spins at the end of input, ignores a hang-up, and takes the terminal over in signal handlers, which
may have interrupted the holder of the very lock that they need. Here writing never blocks, signals
are obeyed between two steps of the event loop, and without its terminal the process ends.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import select
import signal
from codecs import getincrementaldecoder
from functools import partial
from typing import TYPE_CHECKING

from textual import constants
from textual._time import get_time
from textual.drivers.linux_driver import KITTY_REPORT_ALTERNATE_KEYS, LinuxDriver
from textual.events import Key, Resize
from textual.geometry import Size

from tui.terminal.alt_keys import AltKeyParser
from tui.terminal.hang_up import end_when_gone, hung_up
from tui.terminal.output import Terminal
from tui.terminal.pixels import KITTY_QUESTION, QUESTIONS, GraphicsChanged, in_multiplexer
from tui.terminal.stop_scan import PASTE_END, StopScan

if TYPE_CHECKING:
    from textual.app import App
    from textual.message import Message

    from tui.terminal.bandwidth import Bandwidth
    from tui.terminal.pixels import Pixels

    class OnTerminal(App[int]):
        """An app that has a terminal. Its methods here are called on threads of the driver."""

        terminal_fd: int
        bandwidth: Bandwidth
        pixels: Pixels
        stopped_s: float
        """Keys up to this time of the monotonic clock were typed before the last stop."""

        def is_stop(self, key: str) -> bool:
            """Whether this key, pressed now, is the emergency stop."""

        def stop_wheels(self) -> None:
            """Engage the emergency stop, without waiting for anything."""

        def terminal_lost(self) -> None:
            """Stop what is commanded from here, and begin to end."""

        def tell_unread(self, sequence: str) -> None:
            """Say that the terminal has sent something that is no key."""

        def keyboard_lost(self, error: Exception) -> None:
            """Stop the wheels, and end with a word: no key is read any more."""


READ_BYTES = 1024
"""Bytes that are read at once: a stop key behind them waits until they are parsed."""
LOOK_MS = 100
"""How often to check for keys that wait for more of a sequence."""
PASTE_ENDS_S = 2.0
"""When nothing has come of a paste for this long, its end was lost: then keys are keys again."""


class DeckDriver(LinuxDriver):
    """Textual's driver for a terminal that may stall or disappear."""

    def __init__(self, app: OnTerminal, **options: bool | tuple[int, int] | None) -> None:
        """Write to the app's terminal: descriptors 1 and 2 may be redirected."""
        super().__init__(app, **options)  # type: ignore[arg-type]
        self._deck = app
        fd = app.terminal_fd
        repaint = partial(app.call_later, app.refresh, layout=True)
        self._terminal = Terminal(fd, repaint, app.bandwidth, app.pixels.pictures)
        self._file = self._terminal  # type: ignore[assignment]
        self._signals: set[int] = set()
        """Those that wait for the event loop."""
        self._has_told = False
        """Whether it was said that something is no key."""
        self._read: list[Message] = []
        """What was typed, on its way to the app."""
        for number in (signal.SIGTSTP, signal.SIGCONT):
            signal.signal(number, self._on_signal)
        end_when_gone({self.fileno, fd}, app.terminal_lost)

    @property
    def gone(self) -> bool:
        return self._terminal.gone or hung_up(self.fileno)

    def give_up(self) -> None:
        """Stop reading: a terminal that has hung up is always ready to be read, and empty."""
        self.exit_event.set()

    # Input, on a thread of its own

    def run_input_thread(self) -> None:
        """Read until the app ends or the terminal is gone."""
        try:
            self._read_keys()
        except Exception as error:  # noqa: BLE001 - whatever it is, the stop key is gone with it
            self._deck.keyboard_lost(error)

    def _read_keys(self) -> None:
        self._scan = StopScan(self._deck.is_stop)
        self._parser = AltKeyParser()
        self._decode = getincrementaldecoder("utf-8")("replace").decode
        poll = select.poll()
        poll.register(self.fileno, select.POLLIN)
        with contextlib.suppress(OSError):
            while not self.exit_event.is_set():
                if poll.poll(LOOK_MS) and not self._take(os.read(self.fileno, READ_BYTES)):
                    return
                self._look()
                self._hand_over()

    def _take(self, data: bytes) -> bool:
        """Take what was typed; return whether there will be more."""
        if not data:
            # Another program may have left the terminal in a mode in which Ctrl+D ends a line.
            return not hung_up(self.fileno, LOOK_MS)
        pieces = list(self._scan.cut(data))
        if any(stops for _piece, stops in pieces):
            self._deck.stop_wheels()
        for piece, stops in pieces:
            self._parse(self._sifted(self._decode(piece)), stopped=stops)
        if self._parser.dropped and not self._has_told:
            self._has_told = True
            self._deck.tell_unread(self._parser.dropped)
        return True

    def _sifted(self, typed: str) -> str:
        """Return what was typed without answers; tell the app what they change."""
        had = self._deck.pixels.graphics
        keys = self._deck.pixels.sift(typed)
        if self._deck.pixels.graphics != had:
            self.send_message(GraphicsChanged())
        return keys

    def _parse(self, text: str, *, stopped: bool = False) -> None:
        """Parse what was typed; a key that has stopped the wheels already is left out."""
        for event in self._parser.feed(text) if text else ():
            if not (stopped and isinstance(event, Key) and self._deck.is_stop(event.key)):
                self.process_message(event)
        if stopped:
            self._deck.stopped_s = get_time()

    def _look(self) -> None:
        """Take for keys what has waited for more of a sequence, or of a paste, for long enough."""
        if self._scan.overdue():
            self._deck.stop_wheels()
            self._deck.stopped_s = get_time()
        if self._scan.pasting_s > PASTE_ENDS_S:
            self._scan.end_paste()
            self._parse(PASTE_END)
        self._parse(self._sifted(""))
        for event in self._parser.tick():
            self.process_message(event)

    def send_message(self, message: Message) -> None:
        """Keep a message for `_hand_over`; one by one, each would cost a switch of threads."""
        self._read.append(message)

    def _hand_over(self) -> None:
        if self._read:
            read, self._read = self._read, []
            with contextlib.suppress(RuntimeError):  # The loop may have been closed.
                self._loop.call_soon_threadsafe(self._post, read)

    def _post(self, messages: list[Message]) -> None:
        for message in messages:
            self._app.post_message(message)

    # Signals

    def _on_signal(self, number: int, _frame: object) -> None:
        """Note a signal. What was interrupted may hold any lock, so nothing else is done here."""
        if not self._auto_restart:
            # The terminal is an editor's, and the event loop waits for it.
            if number == signal.SIGTSTP:
                os.kill(os.getpid(), signal.SIGSTOP)
        elif number not in self._signals:
            self._signals.add(number)
            with contextlib.suppress(RuntimeError):  # The app has ended.
                self._loop.call_soon_threadsafe(self._obey, number)

    def _obey(self, number: int) -> None:
        self._signals.discard(number)
        if number == signal.SIGTSTP:
            self._sigtstp_application()
        else:
            self._sigcont_application()

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
        self._terminal.leaving = False
        super().start_application_mode()  # type: ignore[no-untyped-call]
        if not constants.DISABLE_KITTY_KEY:
            # Also where on a US keyboard the key is; it goes with what Textual has asked for.
            self.write(f"\x1b[={KITTY_REPORT_ALTERNATE_KEYS};2u")
        asyncio.get_running_loop().add_signal_handler(signal.SIGWINCH, self._tell_size)
        self._ask_for_pixels()

    def _ask_for_pixels(self) -> None:
        """Ask what pictures the terminal understands; it answers when it does, and nobody waits."""
        pixels = self._deck.pixels
        # The console of Linux would print a part of it.
        if pixels.wanted and not self._terminal.leaving and os.environ.get("TERM") != "linux":
            had = pixels.graphics
            pixels.asked(self._terminal.cell())
            if pixels.graphics != had:
                self._app.post_message(GraphicsChanged())
            if not in_multiplexer(os.environ):
                self.write(KITTY_QUESTION)
            self.write(QUESTIONS)

    def _tell_size(self) -> None:
        self._ask_for_pixels()
        # A terminal that reports its size itself, in-band, does so only once.
        if not self._in_band_window_resize:
            size = Size(*self._get_terminal_size())
            self._app.post_message(Resize(size, size))

    # Output

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

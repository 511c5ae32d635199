"""An app on Deck's driver whose main thread hangs as it is told: `python -m ...stuck_app HOW FILE`.

What its driver tells it, it writes to FILE, a line each; so do the keys that reach it.
"""

from __future__ import annotations

import os
import sys
import threading

from textual.app import App
from textual.events import Key
from textual.widgets import Static

from tui.terminal import hang_up
from tui.terminal.bandwidth import Bandwidth
from tui.terminal.driver import DeckDriver
from tui.terminal.pixels import Pixels


class StuckApp(App[int]):
    """Hangs once `h` is pressed."""

    terminal_fd = 1

    def __init__(self, how: str, file: str) -> None:
        super().__init__(driver_class=DeckDriver)
        self._how = how
        self._file = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
        self.bandwidth = Bandwidth()
        self.pixels = Pixels()
        self.stopped_s = 0.0

    def compose(self):  # type: ignore[no-untyped-def]  # noqa: ANN201
        yield Static("ready")

    def on_ready(self) -> None:
        self._write("ready")

    def on_key(self, event: Key) -> None:
        self._write(f"key {event.key}")
        if event.key == "h":
            HANGS[self._how]()

    def on_paste(self) -> None:
        self._write("paste")

    def is_stop(self, key: str) -> bool:
        if key == "b" and self._how == "blind":
            raise RuntimeError(key)
        return key in {"space", "ctrl+x"}

    def stop_wheels(self) -> None:
        self._write("stop")

    def terminal_lost(self) -> None:
        self._write("lost")

    def tell_unread(self, sequence: str) -> None:
        self._write(f"unread {sequence!r}")

    def keyboard_lost(self, error: Exception) -> None:
        self._write(f"keyboard lost: {error!r}")

    def _write(self, words: str) -> None:
        os.write(self._file, f"{words}\n".encode())


def _deadlock() -> None:
    lock = threading.Lock()
    lock.acquire()
    lock.acquire()


def _compute() -> None:
    while True:
        pass


def _block_in_a_write() -> None:
    _reader, writer = os.pipe()
    while True:
        os.write(writer, b"x" * 65536)


HANGS = {"lock": _deadlock, "busy": _compute, "write": _block_in_a_write}

if __name__ == "__main__":
    if sys.argv[1] == "outlive":
        # Long enough to see what its threads do meanwhile.
        hang_up.ORDERLY_END_S = 60.0
    sys.exit(StuckApp(sys.argv[1], sys.argv[2]).run())

"""An app on Deck's driver that writes down what reaches it, a line each: keys, stops, what its driver tells it."""

from __future__ import annotations

import os

from textual.app import App
from textual.events import Key

from tui.terminal.bandwidth import Bandwidth
from tui.terminal.driver import DeckDriver
from tui.terminal.pixels import Pixels


class TerminalApp(App[int]):
    """To be given a screen and a stop key."""

    terminal_fd = 1

    def __init__(self, file: str, pixels: Pixels) -> None:
        """`file` is what it writes to."""
        super().__init__(driver_class=DeckDriver)
        self._file = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
        self.bandwidth = Bandwidth()
        self.pixels = pixels
        self.stopped_s = 0.0

    def write(self, words: str) -> None:
        os.write(self._file, f"{words}\n".encode())

    def on_ready(self) -> None:
        self.write("ready")

    def on_key(self, event: Key) -> None:
        self.write(f"key {event.key}")
        self.obey(event.key)

    def obey(self, key: str) -> None:
        """Do what this key stands for."""
        raise NotImplementedError

    def is_stop(self, key: str) -> bool:
        return key in {"space", "ctrl+x"}

    def stop_wheels(self) -> None:
        self.write("stop")

    def terminal_lost(self) -> None:
        self.write("lost")

    def tell_unread(self, sequence: str) -> None:
        self.write(f"unread {sequence!r}")

    def keyboard_lost(self, error: Exception) -> None:
        self.write(f"keyboard lost: {error!r}")

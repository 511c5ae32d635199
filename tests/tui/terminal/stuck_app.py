"""An app on Deck's driver whose main thread hangs as it is told: `python -m ...stuck_app HOW FILE`.

What its driver tells it, it writes to FILE, a line each; so do the keys that reach it.
"""

from __future__ import annotations

import os
import sys
import threading

from textual.app import ComposeResult
from textual.widgets import Static

from tests.tui.terminal.terminal_app import TerminalApp
from tui.terminal import hang_up
from tui.terminal.pixels import Pixels


class StuckApp(TerminalApp):
    """Hangs once `h` is pressed."""

    def __init__(self, how: str, file: str) -> None:
        super().__init__(file, Pixels())
        self._how = how

    def compose(self) -> ComposeResult:
        yield Static("ready")

    def obey(self, key: str) -> None:
        if key == "h":
            HANGS[self._how]()

    def on_paste(self) -> None:
        self.write("paste")

    def is_stop(self, key: str) -> bool:
        if key == "b" and self._how == "blind":
            raise RuntimeError(key)
        return super().is_stop(key)


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

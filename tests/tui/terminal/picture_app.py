"""An app on Deck's driver that shows a picture as Deck does: `python -m ...picture_app FILE`.

Keys that reach it, and stops, it writes to FILE, a line each. `w` shows words instead, `p` the next picture.
"""

from __future__ import annotations

import os
import sys

import numpy as np
from textual.app import App, ComposeResult
from textual.events import Key

from tui.terminal.bandwidth import Bandwidth
from tui.terminal.driver import DeckDriver
from tui.terminal.harmless import Harmless
from tui.terminal.pixels import GraphicsChanged, Pixels
from tui.widgets.image_view import ImageView


class PictureApp(App[int]):
    """A red picture with a green corner; a blue one after `p`."""

    terminal_fd = 1

    def __init__(self, file: str) -> None:
        super().__init__(driver_class=DeckDriver)
        self._file = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
        self.bandwidth = Bandwidth()
        self.pixels = Pixels(wanted=True)
        self.stopped_s = 0.0

    def compose(self) -> ComposeResult:
        yield ImageView()

    def get_line_filters(self):  # type: ignore[no-untyped-def]  # noqa: ANN201
        return [*super().get_line_filters(), Harmless()]

    def on_ready(self) -> None:
        self.set_timer(0.05, self._begin)

    def _begin(self) -> None:
        """Once the terminal has had the time to answer."""
        self._show(0)
        self._write("ready")

    def _show(self, channel: int) -> None:
        rgb = np.zeros((120, 160, 3), np.uint8)
        rgb[..., channel] = 250
        rgb[:40, :40] = (0, 250, 0)
        self.query_one(ImageView).show(rgb, "a picture")

    def on_graphics_changed(self) -> None:
        self.query_one(ImageView).post_message(GraphicsChanged())

    def on_key(self, event: Key) -> None:
        self._write(f"key {event.key}")
        if event.key == "p":
            self._show(2)
        elif event.key == "w":
            self.query_one(ImageView).show_words("no picture")
        elif event.key == "q":
            self.exit(0)

    def is_stop(self, key: str) -> bool:
        return key == "space"

    def stop_wheels(self) -> None:
        self._write("stop")

    def terminal_lost(self) -> None:
        self.exit(1)

    def tell_unread(self, sequence: str) -> None:
        self._write(f"unread {sequence!r}")

    def keyboard_lost(self, error: Exception) -> None:
        self._write(f"keyboard lost: {error!r}")

    def _write(self, words: str) -> None:
        os.write(self._file, f"{words}\n".encode())


if __name__ == "__main__":
    sys.exit(PictureApp(sys.argv[1]).run())

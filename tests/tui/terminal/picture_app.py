"""An app on Deck's driver that shows a picture as Deck does: `python -m ...picture_app FILE`.

Keys that reach it, and stops, it writes to FILE, a line each. `w` shows words instead, `p` the next picture.
"""

from __future__ import annotations

import sys

import numpy as np
from textual.app import ComposeResult

from tests.tui.terminal.terminal_app import TerminalApp
from tui.terminal.harmless import Harmless
from tui.terminal.pixels import GraphicsChanged, Pixels
from tui.widgets.image_view import ImageView


class PictureApp(TerminalApp):
    """A red picture with a green corner; a blue one after `p`."""

    def __init__(self, file: str) -> None:
        super().__init__(file, Pixels(wanted=True))

    def compose(self) -> ComposeResult:
        yield ImageView()

    def get_line_filters(self):  # type: ignore[no-untyped-def]  # noqa: ANN201
        return [*super().get_line_filters(), Harmless()]

    def on_ready(self) -> None:
        self._show(0)
        super().on_ready()

    def _show(self, channel: int) -> None:
        rgb = np.zeros((120, 160, 3), np.uint8)
        rgb[..., channel] = 250
        rgb[:40, :40] = (0, 250, 0)
        self.query_one(ImageView).show(rgb, "a picture")

    def on_graphics_changed(self) -> None:
        self.query_one(ImageView).post_message(GraphicsChanged())

    def obey(self, key: str) -> None:
        if key == "p":
            self._show(2)
        elif key == "w":
            self.query_one(ImageView).show_words("no picture")
        elif key == "q":
            self.exit(0)


if __name__ == "__main__":
    sys.exit(PictureApp(sys.argv[1]).run())

"""A canvas in true pixels, where the terminal has them: finer than braille, and each dot has a colour of its own."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, cast

import numpy as np

from graph.pictures.pixels import shrink
from tui.widgets.drawing import LOOKS, Ink, Line

if TYPE_CHECKING:
    from collections.abc import Callable

    from tui.terminal.bandwidth import HasBandwidth
    from tui.terminal.pixels import Graphics, PixelPicture
    from tui.widgets.canvas import Canvas
    from tui.widgets.drawing import Drawing
    from tui.widgets.image_view import Pixels

FINER = 3
"""It has so many times the dots of braille, each way."""
PERIOD_S = 0.3
"""As often as the camera's pictures."""


class PixelCanvas:
    """The canvas of one drawing."""

    def __init__(self, drawing: Drawing) -> None:
        self._drawing = drawing
        self._picture: PixelPicture | None = None
        self._shown: Pixels | None = None
        """What is in the picture, or will be."""
        self._wanted: Pixels | None = None
        """What it should show next."""
        self._making = False
        self._graphics: Graphics | None = None
        """What the pictures are made for."""

    def lines(self, columns: int, rows: int, drawn: Callable[[int, int], Canvas]) -> list[Line] | None:
        """Return what `drawn` draws on so many columns and rows, or what it drew last; None if braille has to do."""
        if not self._has_room(columns, rows):
            return None
        rgb = drawn(FINER * columns, FINER * rows).rgb(self._colours(), self._drawing.background_colors[1].rgb)
        if self._shown is None or not np.array_equal(rgb, self._shown):
            self._wanted = rgb
            if not self._making:
                self._making = True
                self._drawing.run_worker(self._make(), group="pixels")
        if self._picture is None or self._picture.halves.shape[:2] != (2 * rows, columns):
            return None
        return [[Ink(self._picture.char * columns)] for _row in range(rows)]

    def _has_room(self, columns: int, rows: int) -> bool:
        """Whether the terminal takes a picture of so many cells; one made for other cells is thrown away."""
        graphics = self._host.pixels.graphics
        if graphics != self._graphics:
            self._graphics, self._picture, self._shown = graphics, None, None
        if graphics is None:
            return False
        (wide, high), largest = graphics.cell, graphics.largest
        return columns * wide <= largest[0] and rows * high <= largest[1]

    @property
    def _host(self) -> HasBandwidth:
        return cast("HasBandwidth", self._drawing.app)

    def _colours(self) -> dict[str, tuple[int, int, int]]:
        looks = {look: "muted" if self._drawing.stale else look for look in ("", *LOOKS)}
        colours = {look: self._drawing.style_of(shown).color for look, shown in looks.items()}
        return {look: colour.get_truecolor() for look, colour in colours.items() if colour is not None}

    async def _make(self) -> None:
        """Make pictures until the newest one is shown."""
        try:
            while self._wanted is not None:
                await asyncio.sleep(PERIOD_S)
                await self._host.bandwidth.free()
                self._shown, self._wanted = self._wanted, None
                height, width = self._shown.shape[:2]
                halves = shrink(self._shown, width // (2 * FINER), height // (2 * FINER))
                graphics, made = self._host.pixels.graphics, await self._host.pixels.made(self._shown, halves)
                await self._host.bandwidth.free()
                self._picture = made if graphics == self._host.pixels.graphics else None
                self._drawing.redraw()
        finally:
            self._making = False

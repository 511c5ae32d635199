"""A camera picture in the terminal, efficient enough to be live over a slow line."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray
from rich.cells import cell_len
from rich.color import Color
from rich.segment import Segment
from rich.style import Style
from textual.events import Resize
from textual.geometry import Region
from textual.strip import Strip
from textual.timer import Timer
from textual.widget import Widget

from graph.data import Sample
from graph.heavy_types import COMPRESSED_IMAGE, IMAGE
from graph.pictures.picture import Picture
from graph.pictures.pixels import ImageError, shrink
from graph.pictures.reading import read_picture
from text.figures import figure
from text.i18n import _, decimal
from text.plain import plain
from tui import clock
from tui.terminal.bandwidth import HasBandwidth, PicturePace
from tui.terminal.pixels import PixelPicture
from tui.widgets.canvas import spans
from tui.widgets.words import OneStyle, cut, in_row, word_strips

CAPTION_FROM = 4
"""Number of rows from which on one of them is used for the caption."""
SCALE_FROM = 8
"""Number of rows from which on one of them is used for a scale, if there is one."""
WIDEST_SCALE = 48
UNPLACED = (200, 60)
"""Columns and rows to assume before the widget has a size."""


Showing = Callable[[Picture], None]
Refusing = Callable[[ImageError], None]


class ImageScale(NamedTuple):
    """The meaning of the colours of a picture, from the first to the last."""

    first: str
    last: str
    colours: Pixels
    """Shape (n, 3)."""


class ShownPicture(NamedTuple):
    """A picture to be shown."""

    rgb: Pixels
    caption: str
    scale: ImageScale | None
    hz: str
    """How many arrive a second; empty if unknown."""


class ImageView(OneStyle, Widget):
    """Shows an RGB picture, or words where there is none: in pixels where the terminal has them, else in half-blocks.

    Of half-blocks only cells whose colour has changed visibly are redrawn. `bits` is the depth of a channel: fewer
    bits mean fewer bytes to the terminal. A picture that replaces another one waits until the line
    to the terminal is free; of those that arrive in the meantime only the newest is shown.
    """

    ALLOW_SELECT = False
    DEFAULT_CSS = """
    ImageView { width: 1fr; height: 1fr; min-height: 3; }
    """

    def __init__(self, *, bits: int = 5) -> None:
        super().__init__()
        self._bits = bits
        self._newest: ShownPicture | None = None
        self._waits = False
        """Whether the newest picture is still waiting to be drawn."""
        self._timer: Timer | None = None
        self._pace = PicturePace()
        self._shown: Pixels | None = None
        self.caption = ""
        self._in_pixels: PixelPicture | None = None
        """The same, if the terminal is to show its pixels."""
        self._encoding: Pixels | None = None
        """The half-blocks of the picture that is on its way into pixels."""
        self._scale: ImageScale | None = None
        self.words = ("", "")
        """Headline and detail shown in place of a picture, both empty if there is one."""
        self._unread: tuple[Sample, Showing, Refusing] | None = None
        """The newest message that came while another was being decoded."""
        self._decoding = False

    def read(self, sample: Sample, show: Showing, refuse: Refusing) -> None:
        """Read the picture of a message, then `show` or `refuse` it; compressed ones that are late are left out."""
        if sample.type_name == IMAGE:
            # It takes a millisecond: less than switching to another thread and back.
            try:
                show(read_picture(IMAGE, sample.value, self.wanted))
            except ImageError as error:
                refuse(error)
            return
        self._unread = sample, show, refuse
        if not self._decoding:
            self._decoding = True
            self.run_worker(self._decode(), group="pictures")

    async def _decode(self) -> None:
        try:
            while self._unread is not None:
                (sample, show, refuse), self._unread = self._unread, None
                try:
                    found = await asyncio.to_thread(read_picture, COMPRESSED_IMAGE, sample.value, self.wanted)
                except ImageError as error:
                    refuse(error)
                else:
                    show(found)
        finally:
            self._decoding = False

    def show(self, rgb: Pixels, caption: str = "", scale: ImageScale | None = None, hz: str = "") -> None:
        """Show a picture of shape (height, width, 3) at any size, with a line of text below it.

        A scale is shown between picture and text; the text ends with the rate. Raises `ValueError`
        if the array has another shape.
        """
        if rgb.shape[2:] != (3,) or not rgb.size:
            raise ValueError(f"a picture has the shape (height, width, 3), not {rgb.shape}")
        self._newest = ShownPicture(rgb, caption, scale, hz)
        self.words = ("", "")
        if self._waits or self._encoding is not None:
            self._pace.left_out(clock.steady())
        elif self._shown is None or not (wait_s := self._host.bandwidth.wait_s()):
            self._take(self._newest)
        else:
            self._waits = True
            self._look_in(wait_s)

    def on_language_changed(self) -> None:
        if self._newest is not None and self._shown is not None:
            self._take(self._newest)

    def on_graphics_changed(self) -> None:
        self._begin_again()

    def show_words(self, headline: str, detail: str = "") -> None:
        if self._newest is None and (headline, detail) == self.words:
            return
        self._newest = self._shown = self._in_pixels = self._encoding = None
        self._waits = False
        self.words, self.caption = (headline, detail), ""
        self._scale = None
        self.refresh()

    @property
    def has_picture(self) -> bool:
        return self._newest is not None

    @property
    def pixel_size(self) -> tuple[int, int]:
        """Width and height in pixels of the available room: a larger picture is of no use."""
        width, height = self.size
        return width, 2 * max(0, height - self._caption_rows(height))

    def wanted(self, width: int, height: int) -> tuple[int, int]:
        """Width and height at which a picture of this size should be decoded.

        Twice as many half-blocks as are shown in each direction: each is the mean of four.
        """
        columns, rows = self.pixel_size[0], self.pixel_size[1] // 2
        if columns < 1 or rows < 1:
            # It is not on the screen yet, and there may never be another picture.
            columns, rows = UNPLACED
        wide, high = self._fitting(width, height, columns, rows)
        graphics = self._host.pixels.graphics
        return (2 * wide, 2 * high) if graphics is None else (wide * graphics.cell[0], high // 2 * graphics.cell[1])

    def render_line(self, y: int) -> Strip:
        width, height = self.size
        if self._shown is None:
            return self._words_strip(y, width, height)
        if y == height - 1 and self._caption_rows(height):
            return self._caption_strip(width)
        if self._scale is not None and y == height - 2 and self._caption_rows(height) > 1:
            return self._scale_strip(self._scale, width)
        top, left = self._margins(self._shown, width, height)
        if not 0 <= y - top < self._shown.shape[0] // 2:
            return Strip.blank(width, self.rich_style)
        if self._in_pixels is None:
            strip = Strip(row_segments(self._shown, y - top), self._shown.shape[1])
        else:
            strip = Strip([Segment(self._in_pixels.char * self._shown.shape[1], _style(None, 0))])
        return in_row(strip, left, width, self.rich_style)

    @property
    def _host(self) -> HasBandwidth:
        return cast("HasBandwidth", self.app)

    def _on_resize(self, _event: Resize) -> None:
        self._begin_again()

    def _begin_again(self) -> None:
        """Take the newest picture as if it were the first: what is on its way into pixels has another size."""
        self._shown = self._in_pixels = self._encoding = None
        if self._newest is not None:
            self._take(self._newest)

    def _look_in(self, wait_s: float) -> None:
        if self._timer is not None:
            self._timer.stop()
        self._timer = self.set_timer(wait_s, self._look_again)

    def _look_again(self) -> None:
        """Draw the newest picture if it may be sent now."""
        if self._newest is None or not self._waits:
            return
        if wait_s := self._host.bandwidth.wait_s():
            self._look_in(wait_s)
        else:
            self._take(self._newest)

    def _take(self, picture: ShownPicture) -> None:
        now_s = clock.steady()
        self._waits = False
        self._pace.shown(now_s)
        self._set_scale(picture.scale)
        has_pixels = self._host.pixels.graphics is not None
        if not has_pixels or self._in_pixels is None:
            self._draw(picture.rgb)
        if has_pixels and self._shown is not None and self._encoding is None and min(self.pixel_size) > 0:
            self._encoding = self._halves(picture.rgb)
            self.run_worker(self._encode(picture, self._encoding), group="pixels")
        caption = picture.caption + self._rate_words(picture.hz, now_s)
        if caption != self.caption:
            self.caption = caption
            self.refresh(Region(0, self.size.height - 1, self.size.width, 1))

    async def _encode(self, picture: ShownPicture, halves: Pixels) -> None:
        """Draw a picture in pixels, made on another thread, and then the newest if there is another."""
        try:
            made = await self._host.pixels.made(picture.rgb, halves)
            # Another picture may have been sent meanwhile.
            await self._host.bandwidth.free()
        finally:
            is_wanted = self._encoding is halves
            if is_wanted:
                self._encoding = None
        if not is_wanted or self._newest is None or self._shown is None:
            return
        fits = self._shown.shape == halves.shape
        if fits and made is not None:
            top, left = self._margins(halves, *self.size)
            self._shown, self._in_pixels = halves, made
            self.refresh(Region(left, top, halves.shape[1], len(halves) // 2))
        elif self._in_pixels is not None:
            self._draw(picture.rgb)
        if self._newest is not picture or not fits:
            self._waits = True
            self._look_again()

    def _rate_words(self, hz: str, now_s: float) -> str:
        shown = self._pace.limited_hz(now_s)
        if not hz:
            return ""
        if shown is None:
            return _(" · {hz} Hz").format(hz=hz)
        if self._host.bandwidth.is_slow:
            words = _(" · {shown} of {hz} Hz: the terminal is slow")
        elif self._host.bandwidth.limit:
            words = _(" · {shown} of {hz} Hz: limited to {limit} kB/s")
        else:
            words = _(" · {shown} of {hz} Hz")
        limit = decimal(f"{self._host.bandwidth.limit / 1000:g}")
        return words.format(shown=figure(shown, 1), hz=hz, limit=limit)

    def _draw(self, source: Pixels) -> None:
        width, height = self.size
        rows = height - self._caption_rows(height)
        if width < 1 or rows < 1:
            return
        had = self._shown
        fresh = self._halves(source)
        if had is None or had.shape != fresh.shape or self._in_pixels is not None:
            self._in_pixels = None
            self._shown = coarser(fresh, self._bits)
            self.refresh()
            return
        now = self._shown = steadied(had, fresh, self._bits)
        top, left = self._margins(now, width, height)
        regions = [Region(left + column, top + row, cells, 1) for row, column, cells in changed_spans(had, now)]
        if regions:
            self.refresh(*regions)

    def _halves(self, source: Pixels) -> Pixels:
        """The picture in the half-blocks of the cells that it takes."""
        rows = self.size.height - self._caption_rows(self.size.height)
        return shrink(source, *self._fitting(source.shape[1], source.shape[0], self.size.width, rows))

    def _fitting(self, width: int, height: int, columns: int, rows: int) -> tuple[int, int]:
        """As `fitting_size`, with cells as they are if they are known."""
        graphics = self._host.pixels.graphics
        if graphics is None:
            return fitting_size(width, height, columns, rows)
        (wide, high), largest = graphics.cell, graphics.largest
        return fitting_size(
            width, height, min(columns, largest[0] // wide), min(rows, largest[1] // high), high / wide
        )

    def _set_scale(self, scale: ImageScale | None) -> None:
        if (scale is None) != (self._scale is None):
            # The picture gains or loses a row.
            self._shown = self._in_pixels = None
            self.refresh()
        elif scale and self._scale and scale[:2] != self._scale[:2]:
            self.refresh(Region(0, max(0, self.size.height - 2), self.size.width, 1))
        self._scale = scale

    def _caption_rows(self, height: int) -> int:
        if height >= SCALE_FROM and self._scale is not None:
            return 2
        return 1 if height >= CAPTION_FROM else 0

    def _margins(self, picture: Pixels, width: int, height: int) -> tuple[int, int]:
        rows = height - self._caption_rows(height)
        return (rows - picture.shape[0] // 2) // 2, (width - picture.shape[1]) // 2

    def _caption_strip(self, width: int) -> Strip:
        style = self.rich_style + Style(dim=True)
        strip = cut([Segment(plain(self.caption), style)], width, style)
        text = strip.text.strip()
        left = (width - cell_len(text)) // 2
        return in_row(Strip([Segment(text, style)]), left, width, style)

    def _scale_strip(self, scale: ImageScale, width: int) -> Strip:
        base = self.rich_style
        room = width - cell_len(scale.first) - cell_len(scale.last) - 2
        cells = min(WIDEST_SCALE, max(0, room))
        colours = scale.colours[[n * len(scale.colours) // max(1, cells) for n in range(cells)]]
        ramp = [Segment(" ", Style.from_color(None, Color.from_rgb(*colour))) for colour in colours.tolist()]
        words = [Segment(f"{scale.first} ", base), *ramp, Segment(f" {scale.last}", base)]
        strip = cut(words, min(width, sum(segment.cell_length for segment in words)), base)
        return in_row(strip, (width - strip.cell_length) // 2, width, base)

    def _words_strip(self, y: int, width: int, height: int) -> Strip:
        strips = word_strips(self.words, width, self.rich_style, self.app.console, centred=True)
        line = y - max(0, (height - len(strips)) // 2)
        if 0 <= line < len(strips):
            return strips[line]
        return Strip.blank(width, self.rich_style)


Pixels: TypeAlias = "NDArray[np.uint8]"
"""Shape (height, width, 3), RGB."""

UPPER_HALF = "▀"
FULL_DEPTH = 8
MOST_STYLES = 4096
MOST_COLOURS = 8192
"""Kept for the next picture: three megabytes, and two for the styles."""


def fitting_size(width: int, height: int, columns: int, rows: int, tall: float = 2.0) -> tuple[int, int]:
    """Width and height in half-blocks of the largest picture of this shape within the given cells.

    A cell is about twice as high as wide, so half of one is about square. The height is even.
    """
    scale = min(columns / width, tall * rows / height)
    fit_width = min(columns, max(1, round(width * scale)))
    fit_height = min(2 * rows, max(2, 2 * round(height * scale / tall)))
    return fit_width, fit_height


def coarser(picture: Pixels, bits: int) -> Pixels:
    """The picture with this many bits in each channel; black stays black and white stays white."""
    if bits >= FULL_DEPTH:
        return picture
    levels = (1 << bits) - 1
    table = (np.arange(256) * levels + 127) // 255 * 255 // levels
    coarse: Pixels = table.astype(np.uint8)[picture]
    return coarse


def steadied(before: Pixels, fresh: Pixels, bits: int) -> Pixels:
    """The new picture, coarser, keeping pixels of the previous one where they hardly differ.

    A pixel between two levels of colour must not flicker with the camera's noise.
    """
    moved = np.abs(fresh.astype(np.int16) - before) > (256 >> bits)
    now: Pixels = np.where(moved.any(axis=2, keepdims=True), coarser(fresh, bits), before)
    return now


def changed_spans(before: Pixels, after: Pixels) -> list[tuple[int, int, int]]:
    """Where two pictures of the same shape differ, as (row of cells, first column, columns)."""
    differ = (before != after).any(axis=2)
    return spans(differ[0::2] | differ[1::2])


def row_segments(picture: Pixels, row: int) -> list[Segment]:
    """One row of cells of a picture of even height; equal neighbours share a segment."""
    wide = picture[2 * row : 2 * row + 2].astype(np.int64)
    packed = (wide[..., 0] << 16) | (wide[..., 1] << 8) | wide[..., 2]
    pairs = (packed[0] << 24) | packed[1]
    starts = np.flatnonzero(np.diff(pairs, prepend=-1))
    ends = np.append(starts[1:], len(pairs))
    segments = []
    for start, end in zip(starts.tolist(), ends.tolist(), strict=True):
        upper, lower = int(pairs[start]) >> 24, int(pairs[start]) & 0xFFFFFF
        sign, style = (" ", _style(None, lower)) if upper == lower else (UPPER_HALF, _style(upper, lower))
        segments.append(Segment(sign * (end - start), style))
    return segments


@lru_cache(maxsize=MOST_STYLES)
def _style(upper: int | None, lower: int) -> Style:
    foreground = None if upper is None else _color(upper)
    return Style.from_color(foreground, _color(lower))


@lru_cache(maxsize=MOST_COLOURS)
def _color(packed: int) -> Color:
    return Color.from_rgb(packed >> 16, packed >> 8 & 255, packed & 255)

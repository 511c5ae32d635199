"""A camera picture in the terminal, cheap enough to be live over a slow line."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style
from textual.geometry import Region
from textual.strip import Strip
from textual.widget import Widget

from graph.images import shrink
from tui.widgets.plain import plain
from tui.widgets.words import cut, in_row, word_strips

if TYPE_CHECKING:
    from textual.events import Resize

    from tui.widgets.half_blocks import Pixels

CAPTION_FROM = 4
"""Rows from which on one of them is given to the caption."""


class ImageView(Widget):
    """Shows an RGB picture in half-blocks, or words where there is none.

    Only cells whose colour changed visibly are drawn again. `bits` is the depth of a channel:
    fewer bits, fewer bytes to the terminal.
    """

    ALLOW_SELECT = False
    DEFAULT_CSS = """
    ImageView { width: 1fr; height: 1fr; min-height: 3; }
    """

    def __init__(self, *, bits: int = 5, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(id=id, classes=classes)
        self._bits = bits
        self._source: Pixels | None = None
        self._shown: Pixels | None = None
        self._caption = ""
        self._headline = ""
        self._detail = ""

    def show(self, rgb: Pixels, caption: str = "") -> None:
        """Show a picture of shape (height, width, 3) at any size, with a line of text under it.

        Raises `ValueError` when the array has another shape.
        """
        if rgb.shape[2:] != (3,) or not rgb.size:
            raise ValueError(f"a picture has the shape (height, width, 3), not {rgb.shape}")
        self._source = rgb
        self._headline = self._detail = ""
        self._draw()
        self._set_caption(caption)

    def show_words(self, headline: str, detail: str = "") -> None:
        """Show why there is no picture, in place of one."""
        if self._source is None and (headline, detail) == (self._headline, self._detail):
            return
        self._source = self._shown = None
        self._headline, self._detail, self._caption = headline, detail, ""
        self.refresh()

    @property
    def has_picture(self) -> bool:
        """Whether a picture is shown now."""
        return self._source is not None

    @property
    def pixel_size(self) -> tuple[int, int]:
        """Width and height in pixels that there is room for: no larger picture is of use."""
        width, height = self.size
        return width, 2 * max(0, height - self._caption_rows(height))

    @property
    def caption(self) -> str:
        """The line under the picture."""
        return self._caption

    @property
    def words(self) -> tuple[str, str]:
        """Headline and detail shown in place of a picture, both empty when there is one."""
        return self._headline, self._detail

    def render_line(self, y: int) -> Strip:
        """One line: of the picture, the caption, or words."""
        width, height = self.size
        if self._shown is None:
            return self._words_strip(y, width, height)
        if y == height - 1 and self._caption_rows(height):
            return self._caption_strip(width)
        top, left = self._margins(self._shown, width, height)
        if not 0 <= y - top < self._shown.shape[0] // 2:
            return Strip.blank(width, self.rich_style)
        from tui.widgets.half_blocks import row_segments

        strip = Strip(row_segments(self._shown, y - top), self._shown.shape[1])
        return in_row(strip, left, width, self.rich_style)

    def _on_resize(self, _event: Resize) -> None:
        self._shown = None
        self._draw()

    def _draw(self) -> None:
        from tui.widgets import half_blocks

        width, height = self.size
        rows = height - self._caption_rows(height)
        if self._source is None or width < 1 or rows < 1:
            return
        had = self._shown
        shape = half_blocks.fitting_size(self._source.shape[1], self._source.shape[0], width, rows)
        fresh = shrink(self._source, *shape)
        if had is None or had.shape != fresh.shape:
            self._shown = half_blocks.coarser(fresh, self._bits)
            self.refresh()
            return
        now = self._shown = half_blocks.steadied(had, fresh, self._bits)
        top, left = self._margins(now, width, height)
        regions = [
            Region(left + column, top + row, cells, 1)
            for row, column, cells in half_blocks.changed_spans(had, now)
        ]
        if regions:
            self.refresh(*regions)

    def _set_caption(self, caption: str) -> None:
        if caption != self._caption:
            self._caption = caption
            self.refresh(Region(0, self.size.height - 1, self.size.width, 1))

    def _caption_rows(self, height: int) -> int:
        return 1 if height >= CAPTION_FROM else 0

    def _margins(self, picture: Pixels, width: int, height: int) -> tuple[int, int]:
        rows = height - self._caption_rows(height)
        return (rows - picture.shape[0] // 2) // 2, (width - picture.shape[1]) // 2

    def _caption_strip(self, width: int) -> Strip:
        style = self.rich_style + Style(dim=True)
        strip = cut([Segment(plain(self._caption), style)], width, style)
        text = strip.text.strip()
        left = (width - cell_len(text)) // 2
        return in_row(Strip([Segment(text, style)]), left, width, style)

    def _words_strip(self, y: int, width: int, height: int) -> Strip:
        words = (self._headline, self._detail)
        strips = word_strips(words, width, self.rich_style, self.app.console, centred=True)
        line = y - max(0, (height - len(strips)) // 2)
        if 0 <= line < len(strips):
            return strips[line]
        return Strip.blank(width, self.rich_style)

"""Lines that a widget draws itself: words in place of what cannot be shown, and its style computed once."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.console import Console
from rich.segment import Segment
from rich.style import Style
from rich.text import Text
from textual.strip import Strip

from text.plain import plain

if TYPE_CHECKING:
    from rich.style import Style
    from textual.geometry import Region
    from textual.strip import Strip
    from textual.widget import Widget as Base
else:
    # Textual looks for a widget's CSS along the first base class that is a widget.
    Base = object


class OneStyle(Base):
    """Mixin for a widget that draws line by line: computing `rich_style` takes Textual 0.2 ms."""

    __drawing = False
    __style: Style | None = None

    def render_lines(self, crop: Region) -> list[Strip]:
        self.__drawing = True
        try:
            return super().render_lines(crop)
        finally:
            self.__drawing, self.__style = False, None

    @property
    def rich_style(self) -> Style:
        if not self.__drawing:
            return super().rich_style
        if self.__style is None:
            self.__style = super().rich_style
        return self.__style


def word_strips(
    words: tuple[str, str], width: int, base: Style, console: Console, *, centred: bool = False
) -> list[Strip]:
    """Headline and detail as lines of exactly `width` cells, the headline bold, the detail dim."""
    strips: list[Strip] = []
    for text, style in zip(words, (base + Style(bold=True), base + Style(dim=True)), strict=True):
        for line in Text(plain(text)).wrap(console, max(1, width)) if text else ():
            strip = Strip([Segment(line.plain, style)])
            left = max(0, width - strip.cell_length) // 2 if centred else 0
            strips.append(in_row(strip, left, width, base))
    return strips


def in_row(strip: Strip, left: int, width: int, base: Style) -> Strip:
    margin = [Segment(" " * left, base)] if left else []
    return Strip([*margin, *strip]).adjust_cell_length(width, base)


def cut(segments: list[Segment], width: int, base: Style) -> Strip:
    """A strip of exactly `width` cells, with an ellipsis if it was cut."""
    strip = Strip(segments)
    if strip.cell_length <= width:
        return strip.adjust_cell_length(width, base)
    shown = strip.crop(0, max(0, width - 1))
    last = next((segment.style for segment in reversed(list(shown)) if segment.text), base)
    return Strip([*shown, Segment("…", last)]).adjust_cell_length(width, base)

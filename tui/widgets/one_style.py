"""A widget's own style, computed once for all lines of a drawing."""

from __future__ import annotations

from typing import TYPE_CHECKING

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

"""The rows of the table of topics on the screen: drawn cell by cell, where a text has changed."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, TypeAlias

from rich.segment import Segment
from textual.geometry import Region
from textual.scroll_view import ScrollView
from textual.strip import Strip

from text.i18n import _
from tui.topics.table_columns import PlacedColumn, needs_mending, placed
from tui.topics.table_order import TopicsOrder
from tui.widgets.one_style import OneStyle
from tui.widgets.words import word_strips

if TYPE_CHECKING:
    from rich.style import Style

    from graph.data import TopicRow

HEADER = 1
MARK = 2
"""Cells left of the first column, for the mark of the chosen row."""
_Drawn: TypeAlias = "tuple[bool, tuple[str, ...]]"
"""Whether the row was the chosen one, and the texts of its cells, as they were last drawn."""


class TopicsRows(OneStyle, ScrollView, can_focus=True):
    """Draws a header and the rows in `_shown`; what they are and which is chosen, others decide."""

    ALLOW_SELECT = False
    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "topics-table--header",
        "topics-table--sorted",
        "topics-table--trouble",
        "topics-table--cursor",
    }
    DEFAULT_CSS = """
    TopicsRows {
        width: 1fr; height: 1fr; overflow-x: hidden; scrollbar-size-vertical: 1;
        &> .topics-table--header { color: $text-muted; text-style: bold; background: $panel; }
        &> .topics-table--sorted { color: $text; }
        &> .topics-table--trouble { color: $text-warning; }
        &> .topics-table--cursor { background: $block-cursor-blurred-background; }
        &:focus > .topics-table--cursor {
            color: $block-cursor-foreground; background: $block-cursor-background;
        }
    }
    """

    def __init__(self, *, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(id=id, classes=classes)
        self._shown: list[TopicRow] = []
        self._order = TopicsOrder()
        self._chosen: str | None = None
        self._places: tuple[PlacedColumn, ...] = ()
        self._drawn: dict[int, _Drawn] = {}
        """By the line of the widget."""

    def render_line(self, y: int) -> Strip:
        """The header, a topic, or words where there are none."""
        width = self.size.width
        base = self.rich_style
        if y < HEADER:
            return self._header(width)
        index = y - HEADER + self.scroll_offset.y
        if index < len(self._shown):
            return self._row_strip(y, self._shown[index], width)
        if not self._shown:
            strips = word_strips(self._empty_words(), width, base, self.app.console)
            if y - HEADER < len(strips):
                return strips[y - HEADER]
        return Strip.blank(width, base)

    def on_resize(self) -> None:
        """PlacedColumn the columns anew."""
        self._place()

    def watch_show_vertical_scrollbar(self) -> None:
        """Make room for the scroll bar, or use what it has left."""
        self._place()

    def on_focus(self) -> None:
        """Draw the cursor as that of the focused widget."""
        self._refresh_chosen()

    def on_blur(self) -> None:
        """Draw the cursor as that of a widget in the background."""
        self._refresh_chosen()

    def _empty_words(self) -> tuple[str, str]:
        """Return headline and detail for a table without rows."""
        return "", ""

    def _place(self) -> None:
        """PlacedColumn the columns, anew only if the room or the longest name has changed."""
        longest = max((len(row.name) for row in self._shown), default=0)
        places = placed(max(1, self.scrollable_size.width - MARK), longest)
        if places != self._places:
            self._places = places
            self._drawn.clear()
            self.refresh()

    def _index(self, topic: str | None) -> int | None:
        return next((i for i, row in enumerate(self._shown) if row.name == topic), None)

    def _is_visible(self, index: int) -> bool:
        return 0 <= index - self.scroll_offset.y < self.size.height - HEADER

    def _refresh_chosen(self) -> None:
        index = self._index(self._chosen)
        if index is not None:
            y = index + HEADER - self.scroll_offset.y
            if y >= HEADER:
                self.refresh(Region(0, y, self.size.width, 1))

    def _refresh_changed(self) -> None:
        top = self.scroll_offset.y
        for index in range(top, min(len(self._shown), top + self.size.height - HEADER)):
            y = index - top + HEADER
            drawn, now = self._drawn.get(y), self._to_draw(self._shown[index])
            if drawn is None or drawn == now:
                continue
            self._drawn[y] = now
            if drawn[0] != now[0]:
                self.refresh(Region(0, y, self.size.width, 1))
                continue
            for place, old, new in zip(self._places, drawn[1], now[1], strict=True):
                if old != new:
                    self.refresh(Region(MARK + place.x, y, place.width, 1))

    def _to_draw(self, row: TopicRow) -> _Drawn:
        cells = tuple(place.fitted(place.column.text(row)) for place in self._places)
        return row.name == self._chosen, cells

    def _row_strip(self, y: int, row: TopicRow, width: int) -> Strip:
        chosen, cells = self._drawn[y] = self._to_draw(row)
        base = self.rich_style
        if chosen:
            base = self.get_component_rich_style("topics-table--cursor")
        trouble = base
        if needs_mending(row) and not chosen:
            trouble += self.get_component_rich_style("topics-table--trouble", partial=True)
        styles = [trouble if place.column.id == "state" else base for place in self._places]
        return self._strip("▶ " if chosen else "", cells, styles, width, base)

    def _header(self, width: int) -> Strip:
        style = self.get_component_rich_style("topics-table--header")
        # A partial style would not know whether it stands on a dark or on a light ground.
        sorted_by = self.get_component_rich_style("topics-table--sorted")
        by_style = style + type(style)(color=sorted_by.color)
        by, arrow = self._order.column, "▼" if self._order.falling else "▲"
        styles = [by_style if place.column is by else style for place in self._places]
        titles = tuple(
            place.fitted(_(place.column.title) + (arrow if place.column is by else ""))
            for place in self._places
        )
        return self._strip("", titles, styles, width, style)

    def _strip(
        self, mark: str, cells: tuple[str, ...], styles: list[Style], width: int, base: Style
    ) -> Strip:
        runs: list[tuple[str, Style]] = [(mark.ljust(MARK), base)]
        end = 0
        for place, text, style in zip(self._places, cells, styles, strict=True):
            padded = " " * (place.x - end) + text
            end = place.x + place.width
            # Every segment costs the terminal some forty bytes of colours.
            if style == runs[-1][1]:
                runs[-1] = (runs[-1][0] + padded, style)
            else:
                runs.append((padded, style))
        segments = [Segment(text, style) for text, style in runs]
        return Strip(segments).adjust_cell_length(width, base)

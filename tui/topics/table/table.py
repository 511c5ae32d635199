"""All topics in a table: sorted, filtered, and one of them chosen.

Only cells whose text has changed are redrawn.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar, TypeAlias

from rich.segment import Segment
from textual.binding import Binding, BindingType
from textual.geometry import Region, Size
from textual.message import Message
from textual.scroll_view import ScrollView
from textual.strip import Strip

from text.i18n import _
from tui.topics.table.columns import PlacedColumn, has_problem, placed
from tui.topics.table.order import TopicsOrder
from tui.widgets.one_style import OneStyle
from tui.widgets.words import word_strips

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rich.style import Style
    from textual.events import Click

    from graph.data import TopicRow

HEADER = 1
MARK = 2
"""Cells left of the first column, for the mark of the chosen row."""
FAR = 1_000_000
_Drawn: TypeAlias = "tuple[bool, tuple[str, ...]]"
"""Whether the row was the chosen one, and the texts of its cells, as last drawn."""


class TopicsTable(OneStyle, ScrollView, can_focus=True):
    """Shows `TopicRow`s; one is chosen, and stays chosen while rows come, go and are sorted."""

    class TopicChosen(Message):
        """Another topic was chosen; None if there is none."""

        def __init__(self, topic: str | None) -> None:
            super().__init__()
            self.topic = topic

    class TopicOpened(Message):
        """Enter was pressed on the chosen topic."""

    class Arranged(Message):
        """The order, the filter or the set of topics has changed."""

    ALLOW_SELECT = False
    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "topics-table--header",
        "topics-table--sorted",
        "topics-table--trouble",
        "topics-table--cursor",
    }
    DEFAULT_CSS = """
    TopicsTable {
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

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up,k", "move(-1)", show=False),
        Binding("down,j", "move(1)", show=False),
        Binding("pageup", "page(-1)", show=False),
        Binding("pagedown", "page(1)", show=False),
        Binding("home,g", f"move(-{FAR})", show=False),
        Binding("end,G", f"move({FAR})", show=False),
        Binding("enter", "open", show=False),
    ]

    def __init__(self, *, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(id=id, classes=classes)
        self._rows: Sequence[TopicRow] = ()
        self._shown: list[TopicRow] = []
        self._order = TopicsOrder()
        self._chosen: str | None = None
        self._words = ("", "")
        self._places: tuple[PlacedColumn, ...] = ()
        self._drawn: dict[int, _Drawn] = {}
        """By line of the widget."""

    def show(self, rows: Sequence[TopicRow]) -> None:
        self._rows = rows
        self._arrange()

    def show_words(self, headline: str, detail: str = "") -> None:
        """Set the words that are shown while there are no rows."""
        if (headline, detail) != self._words:
            self._words = (headline, detail)
            if not self._shown:
                self.refresh()

    @property
    def order(self) -> TopicsOrder:
        """The column to sort by, and what is left out."""
        return self._order

    def reorder(self, order: TopicsOrder) -> None:
        if order != self._order:
            self._order = order
            self._arrange()
            self.refresh(Region(0, 0, self.size.width, HEADER))
            self.post_message(self.Arranged())

    def filter(self, words: str) -> None:
        """Show only topics whose name or type contains each of these words."""
        self.reorder(replace(self._order, words=words))

    def sort_by_next(self) -> None:
        """Sort by the next one of the columns that are shown."""
        self.reorder(self._order.next_column([place.column.id for place in self._places]))

    @property
    def chosen(self) -> str | None:
        return self._chosen

    @property
    def chosen_row(self) -> TopicRow | None:
        return next((row for row in self._shown if row.name == self._chosen), None)

    @property
    def shown(self) -> Sequence[TopicRow]:
        return self._shown

    def choose(self, topic: str) -> None:
        """Choose a topic by name, if it is shown."""
        index = self._index(topic)
        if index is not None:
            self._choose(index)

    def action_move(self, by: int) -> None:
        """Choose the row this many below."""
        if self._shown:
            at = self._index(self._chosen) or 0
            self._choose(max(0, min(at + by, len(self._shown) - 1)))

    def action_page(self, pages: int) -> None:
        """Choose the row a page away."""
        self.action_move(pages * max(1, self.size.height - HEADER - 1))

    def action_open(self) -> None:
        if self._chosen is not None:
            self.post_message(self.TopicOpened())

    def on_click(self, event: Click) -> None:
        """Choose a topic, or a column to sort by."""
        if event.y >= HEADER:
            index = event.y - HEADER + self.scroll_offset.y
            if index < len(self._shown):
                self._choose(index)
            return
        for place in self._places:
            if place.x <= event.x - MARK <= place.x + place.width:
                self.reorder(self._order.by(place.column.id))

    def _arrange(self) -> None:
        at = self._index(self._chosen)
        was_visible = at is not None and self._is_visible(at)
        count = len(self._shown)
        self._shown = self._order.arranged(self._rows)
        self._place()
        if count != len(self._shown):
            self.virtual_size = Size(0, HEADER + len(self._shown))
            self.refresh()
        self._keep_chosen(at)
        now = self._index(self._chosen)
        if was_visible and now is not None and now != at:
            self._bring_into_view(now)
        self._refresh_changed()

    def _keep_chosen(self, before: int | None) -> None:
        """If the chosen topic has gone, choose the one that has taken its place."""
        if self._index(self._chosen) is not None:
            return
        if self._shown:
            self._choose(min(before or 0, len(self._shown) - 1))
        elif self._chosen is not None:
            self._chosen = None
            self.post_message(self.TopicChosen(None))

    def _choose(self, index: int) -> None:
        topic = self._shown[index].name
        if topic != self._chosen:
            self._refresh_chosen()
            self._chosen = topic
            self._refresh_chosen()
            self.post_message(self.TopicChosen(topic))
        self._bring_into_view(index)

    def _bring_into_view(self, index: int) -> None:
        top, rows = self.scroll_offset.y, max(1, self.size.height - HEADER)
        target = min(index, max(top, index - rows + 1))
        if target != top:
            # New rows have no scroll bar yet, and without it Textual would not scroll.
            self.scroll_to(y=target, animate=False, immediate=True, force=True)

    def _empty_words(self) -> tuple[str, str]:
        if self._rows and self._order.words:
            return _("no topic matches “{words}”").format(words=self._order.words), ""
        return self._words

    # Drawing

    def render_line(self, y: int) -> Strip:
        """The header, a topic, or words if there are none."""
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
        """Lay out the columns again."""
        self._place()

    def watch_show_vertical_scrollbar(self) -> None:
        """Lay out the columns with or without the scroll bar."""
        self._place()

    def on_focus(self) -> None:
        """Draw the cursor as focused."""
        self._refresh_chosen()

    def on_blur(self) -> None:
        """Draw the cursor as unfocused."""
        self._refresh_chosen()

    def _place(self) -> None:
        """Lay out the columns, but only if the width or the longest name has changed."""
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
        if has_problem(row) and not chosen:
            trouble += self.get_component_rich_style("topics-table--trouble", partial=True)
        styles = [trouble if place.column.id == "state" else base for place in self._places]
        return self._strip("▶ " if chosen else "", cells, styles, width, base)

    def _header(self, width: int) -> Strip:
        style = self.get_component_rich_style("topics-table--header")
        # A partial style would not know whether its background is dark or light.
        sorted_by = self.get_component_rich_style("topics-table--sorted")
        by_style = style + type(style)(color=sorted_by.color)
        by, arrow = self._order.column, "▼" if self._order.falling else "▲"
        styles = [by_style if place.column is by else style for place in self._places]
        titles = tuple(
            place.fitted(_(place.column.title) + (arrow if place.column is by else "")) for place in self._places
        )
        return self._strip("", titles, styles, width, style)

    def _strip(self, mark: str, cells: tuple[str, ...], styles: list[Style], width: int, base: Style) -> Strip:
        runs: list[tuple[str, Style]] = [(mark.ljust(MARK), base)]
        end = 0
        for place, text, style in zip(self._places, cells, styles, strict=True):
            padded = " " * (place.x - end) + text
            end = place.x + place.width
            # Every segment costs about forty bytes of colour sequences.
            if style == runs[-1][1]:
                runs[-1] = (runs[-1][0] + padded, style)
            else:
                runs.append((padded, style))
        segments = [Segment(text, style) for text, style in runs]
        return Strip(segments).adjust_cell_length(width, base)

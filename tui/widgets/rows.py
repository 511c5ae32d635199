"""A list of rows with a cursor, which redraws only the cells whose text has changed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, NamedTuple

from rich.cells import cell_len, set_cell_size
from rich.segment import Segment
from rich.style import Style
from textual.binding import Binding, BindingType
from textual.events import Click
from textual.geometry import Region, Size
from textual.message import Message
from textual.scroll_view import ScrollView
from textual.strip import Strip

from tui.widgets.words import OneStyle

MARK = 2
"""Cells left of the first column, for the mark of the chosen row."""
FAR = 1_000_000


class Column(NamedTuple):
    """A column of `width` cells; with 0 it takes the remaining width."""

    title: str
    width: int = 0
    right: bool = False
    look: str = ""
    """Of the title: `sorted` or none."""


class Cell(NamedTuple):
    """A text and its meaning: `good`, `warn`, `bad`, `dim` or none."""

    text: str
    meaning: str = ""


class Row(NamedTuple):
    """A row with the key by which it is chosen; without one it is a heading.

    If there are fewer cells than columns, the last cell takes the room of the missing ones.
    """

    key: str
    cells: tuple[Cell, ...]


class Rows(OneStyle, ScrollView, can_focus=True):
    """Shows rows; one of them is chosen, and stays chosen while others change."""

    class Highlighted(Message):
        """Another row was chosen."""

        def __init__(self, rows: Rows, key: str) -> None:
            super().__init__()
            self.rows = rows
            self.key = key

        @property
        def control(self) -> Rows:
            return self.rows

    class Opened(Highlighted):
        """Enter was pressed on the chosen row, or it was clicked a second time."""

    ALLOW_SELECT = False
    COMPONENT_CLASSES: ClassVar[set[str]] = {
        f"rows--{part}" for part in ["header", "cursor", "good", "warn", "bad", "dim", "sorted"]
    }
    DEFAULT_CSS = """
    Rows {
        width: 1fr; height: 1fr; overflow-x: hidden; scrollbar-size-vertical: 1;
        &> .rows--header { color: $text-muted; text-style: bold; background: $panel; }
        &> .rows--good { color: $text-success; }
        &> .rows--warn { color: $text-warning; }
        &> .rows--bad { color: $text-error; text-style: bold; }
        &> .rows--dim { color: $text-muted; }
        &> .rows--sorted { color: $text; text-style: bold; }
        &> .rows--cursor { background: $block-cursor-blurred-background; }
        &:focus > .rows--cursor {
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

    def __init__(self, *, header: bool = True, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(id=id, classes=classes)
        self._top = 1 if header else 0
        self._columns: tuple[Column, ...] = ()
        self._widths: tuple[int, ...] = ()
        self._placed_in = 0
        """The width for which the columns were laid out."""
        self._rows: tuple[Row, ...] = ()
        self.chosen = ""
        """Key of the chosen row, empty if there is none."""
        self._moved = False

    def show(self, columns: Sequence[Column], rows: Sequence[Row], *, near: int = 0) -> None:
        """Show these rows in these columns; texts must be harmless and have no line breaks.

        If the chosen row has gone, the one at the place `near` is chosen.
        """
        before, self._rows = self._rows, tuple(rows)
        if tuple(columns) != self._columns:
            self._columns = tuple(columns)
            self._place()
        if len(before) != len(self._rows):
            self.virtual_size = Size(0, self._top + len(self._rows))
            self.refresh()
        if self._index(self.chosen) is None:
            self._choose_near(max(0, min(near, len(self._rows) - 1)))
        if self._widths:
            self._refresh_changed(before)

    @property
    def is_chosen_cut(self) -> bool:
        """Whether a text of the chosen row does not fit into its column."""
        index = self._index(self.chosen)
        if index is None:
            return False
        if self._placed_in != self.scrollable_size.width:
            self._place()
        cells = self._rows[index].cells
        rooms = self._room_for(len(cells))
        return any(cell_len(cell.text) > room for cell, room in zip(cells, rooms))  # noqa: B905

    def column_at(self, x: int) -> int | None:
        """Return the number of the column at this cell."""
        right = MARK
        for at, width in enumerate(self._widths):
            right += width + 1
            if MARK <= x < right:
                return at
        return None

    def choose(self, key: str) -> None:
        index = self._index(key)
        if index is not None:
            self._choose(index)

    def render_lines(self, crop: Region) -> list[Strip]:
        """Some lines; Textual does not always report a new size if several layouts coincide."""
        if self._placed_in != self.scrollable_size.width:
            self._place()
        return super().render_lines(crop)

    def render_line(self, y: int) -> Strip:
        width, base = self.size.width, self.rich_style
        if y < self._top:
            style = self.get_component_rich_style("rows--header")
            return self._strip([Cell(column.title, column.look) for column in self._columns], "  ", style, width)
        index = y - self._top + self.scroll_offset.y
        if index >= len(self._rows):
            return Strip.blank(width, base)
        row = self._rows[index]
        chosen = bool(row.key) and row.key == self.chosen
        if chosen:
            base += self.get_component_rich_style("rows--cursor")
        return self._strip(row.cells, "▶ " if chosen else "  ", base, width, plain=chosen)

    def action_move(self, by: int) -> None:
        self._moved = True
        at = self._index(self.chosen)
        self._choose_near(max(0, min((at or 0) + by, len(self._rows) - 1)), -1 if by < 0 else 1)

    def action_page(self, pages: int) -> None:
        self.action_move(pages * max(1, self.size.height - self._top - 1))

    def action_open(self) -> None:
        if self.chosen:
            self.post_message(self.Opened(self, self.chosen))

    def on_click(self, event: Click) -> None:
        index = event.y - self._top + self.scroll_offset.y
        if event.y >= self._top and index < len(self._rows) and self._rows[index].key:
            self._moved = True
            again = self._rows[index].key == self.chosen
            self._choose(index)
            if again and event.chain > 1:
                self.action_open()

    def on_resize(self) -> None:
        self._place()
        index = self._index(self.chosen)
        if index is not None:
            # What was chosen while there was little room may have scrolled off the rows above it.
            self._bring_into_view(index, self.scroll_offset.y if self._moved else 0)

    def watch_show_vertical_scrollbar(self) -> None:
        """Lay out the columns with or without the scroll bar."""
        self._place()

    def on_focus(self) -> None:
        self._refresh_row(self._index(self.chosen))

    def on_blur(self) -> None:
        self._refresh_row(self._index(self.chosen))

    def _place(self) -> None:
        self._placed_in = self.scrollable_size.width
        self._widths = _widths(self._columns, self._placed_in - MARK)
        self.refresh()

    def _index(self, key: str) -> int | None:
        return next((i for i, row in enumerate(self._rows) if row.key and row.key == key), None)

    def _choose_near(self, index: int, step: int = 1) -> None:
        """Choose this row or, if it is a heading, the nearest row, in direction `step` first."""
        below, above = range(index, len(self._rows)), range(index, -1, -1) if self._rows else ()
        places = (*below, *above) if step > 0 else (*above, *below)
        found = next((place for place in places if self._rows[place].key), None)
        if found is not None:
            self._choose(found)
        elif not any(row.key for row in self._rows):
            self.chosen = ""

    def _choose(self, index: int) -> None:
        key = self._rows[index].key
        if key != self.chosen:
            self._refresh_row(self._index(self.chosen))
            self.chosen = key
            self._refresh_row(index)
            self.post_message(self.Highlighted(self, key))
        self._bring_into_view(index, self.scroll_offset.y)

    def _bring_into_view(self, index: int, top: int) -> None:
        """Scroll as little as needed, assuming that row `top` is the first in sight."""
        rows = max(1, self.size.height - self._top)
        target = min(index, max(top, index - rows + 1))
        if index < rows and not any(row.key for row in self._rows[:index]):
            # The rows above the first one are its heading.
            target = 0
        if target != self.scroll_offset.y:
            # New rows have no scroll bar yet, and without it Textual would not scroll.
            self.scroll_to(y=target, animate=False, immediate=True, force=True)

    def _refresh_row(self, index: int | None) -> None:
        if index is not None and index >= self.scroll_offset.y:
            y = index + self._top - self.scroll_offset.y
            self.refresh(Region(0, y, self.size.width, 1))

    def _refresh_changed(self, before: tuple[Row, ...]) -> None:
        top = self.scroll_offset.y
        last = min(len(before), len(self._rows), top + self.size.height)
        for index in range(top, last):
            old, new = before[index], self._rows[index]
            if old.key != new.key or len(old.cells) != len(new.cells):
                self._refresh_row(index)
                continue
            x, y = MARK, index - top + self._top
            widths = self._room_for(len(new.cells))
            for width, was, now in zip(widths, old.cells, new.cells, strict=True):
                if was != now:
                    self.refresh(Region(x, y, width, 1))
                x += width + 1

    def _room_for(self, cells: int) -> tuple[int, ...]:
        if not cells or cells >= len(self._widths):
            return self._widths
        kept = self._widths[: cells - 1]
        return (*kept, max(0, self.scrollable_size.width - MARK - sum(kept) - len(kept)))

    def _ink(self, name: str) -> Style:
        """Return the colour of a component, blended with the background, and its weight.

        A partial style would not include the opacity, nor whether an automatic colour is dark or
        light.
        """
        look = self.get_component_rich_style(name)
        return type(look)(color=look.color, bold=look.bold)

    def _strip(self, cells: Sequence[Cell], mark: str, base: Style, width: int, *, plain: bool = False) -> Strip:
        segments = [Segment(mark, base)]
        widths = self._room_for(len(cells))
        for column, cell, room in zip(self._columns, cells, widths):  # noqa: B905
            style = base
            if cell.meaning and not plain:
                style = base + self._ink(f"rows--{cell.meaning}")
            right = column.right and len(cells) == len(self._columns)
            segments.append(Segment(_fitted(cell.text, room, right), style))
            segments.append(Segment(" ", base))
        # Every segment costs about forty bytes of colour sequences.
        return Strip(segments).simplify().adjust_cell_length(width, base)


def _widths(columns: Sequence[Column], width: int) -> tuple[int, ...]:
    """Divide `width` cells among the columns, with one blank between them."""
    fixed = sum(column.width for column in columns) + max(0, len(columns) - 1)
    free = [column for column in columns if not column.width]
    spare = max(0, width - fixed)
    widths: list[int] = []
    for column in columns:
        share = column.width or spare // len(free)
        if free and column is free[0]:
            share += spare % len(free)
        widths.append(share)
    return tuple(widths)


def _fitted(text: str, width: int, right: bool) -> str:
    blank = width - cell_len(text)
    if blank < 0:
        return set_cell_size(text, max(0, width - 1)) + "…" if width else ""
    return " " * blank + text if right else text + " " * blank

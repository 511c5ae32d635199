"""The rows of a log as they are drawn: columns, colours of the nodes, and a cache of rows."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, TypeAlias

from rich.cells import cell_len
from textual.cache import LRUCache

from text.plain import plain
from tui.log_view.paint import RowPainter
from tui.log_view.palette import palette_of
from tui.log_view.rows import LogColumns, gutter_texts

if TYPE_CHECKING:
    from textual.selection import Selection
    from textual.strip import Strip
    from textual.widget import Widget

    from tui.log_view.index import LogIndex
    from tui.log_view.ring import LogEntry

ColumnsFor: TypeAlias = "Callable[[int, int], LogColumns]"
"""Returns the columns in front of the text, for the given widths of a row and the longest node."""
LEAST_TEXT = 8
PAGES_KEPT = 2
"""Drawn rows that are kept, in heights of the view: a row takes two kilobytes."""


class DrawnRows:
    """Draws the rows of an index for a widget, and keeps them until they look different."""

    def __init__(self, widget: Widget, index: LogIndex, columns_for: ColumnsFor, *, fold: bool) -> None:
        """Use the colours of `widget`; with `fold` long lines are wrapped, else shifted."""
        self.fold = fold
        self._widget = widget
        self._index = index
        self._columns_for = columns_for
        self._columns = LogColumns(0, 0, 0)
        self._width = 0
        self._shift = 0
        self._node_places: dict[str, int] = {}
        self._longest_node = 4
        self._painter: RowPainter | None = None
        self._strips: LRUCache[tuple[int, int], Strip] = LRUCache(1)

    def know_nodes(self, names: Iterable[str]) -> bool:
        """Assign colours to these nodes, in this order; return whether one needs a wider column."""
        for name in names:
            self._node_places.setdefault(name, len(self._node_places))
        longest = max(map(len, self._node_places), default=0)
        wider = longest > self._longest_node
        self._longest_node = max(longest, self._longest_node)
        return wider

    def lay_out(self, width: int, height: int) -> None:
        """Fit columns and wrapping to rows of this width, of which so many are seen at once."""
        self._strips.maxsize = max(1, PAGES_KEPT * height)
        self._width = width
        self._columns = self._columns_for(width, self._longest_node)
        self._index.fold(self._text_width if self.fold else None)
        self.forget()

    def set_fold(self, fold: bool) -> None:
        """Wrap long lines, or show one row of each; call `lay_out` afterwards."""
        self.fold, self._shift = fold, 0

    def shift(self, cells: int) -> bool:
        """Shift unwrapped lines to the left; return whether they look different now."""
        most = 0 if self.fold else max(0, self._index.longest - self._text_width)
        shift = max(0, min(self._shift + cells, most))
        shifted, self._shift = shift != self._shift, shift
        return shifted

    def forget(self) -> None:
        """Discard all drawn rows, since they look different now."""
        self._painter = None
        self._strips.clear()

    def cuts(self, node: str) -> bool:
        """Whether the column has no room for the name of this node."""
        return cell_len(plain(node)) > self._columns.node

    def text(self, entry: LogEntry) -> str:
        """Columns and text of a line as they are drawn, but unwrapped."""
        return "".join(gutter_texts(entry, self._columns)) + self._index.text_of(entry)

    def strip(self, entry: LogEntry, part: int, selection: Selection | None, *, chosen: bool) -> Strip:
        """Row number `part` of a line."""
        strip = None if selection else self._strips.get((entry.id, part))
        if strip is None:
            strip = self._draw(entry, part, selection, chosen=chosen)
            if selection is None:
                self._strips[entry.id, part] = strip
        return strip

    @property
    def _text_width(self) -> int:
        return max(LEAST_TEXT, self._width - self._columns.gutter)

    def _draw(self, entry: LogEntry, part: int, selection: Selection | None, *, chosen: bool) -> Strip:
        painter = self._painter
        if painter is None:
            painter = self._painter = RowPainter(
                palette_of(self._widget),
                self._columns,
                self._text_width,
                self._shift,
                self.fold,
                self._index.filter.pattern,
            )
        node_style = painter.palette.node(self._node_places[entry.node])
        text = self._index.text_of(entry)
        strip = painter.row(entry, part, text, node_style, selection, chosen=chosen)
        return strip.adjust_cell_length(self._widget.size.width, self._widget.rich_style)

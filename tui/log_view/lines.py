"""The lines of many nodes, filtered and drawn: what a log view shows.

Each line is looked at once, by the filter, when it comes; only rows on screen are ever drawn.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, ClassVar

from rich.cells import cell_len
from rich.segment import Segment
from textual.cache import LRUCache
from textual.strip import Strip

from launcher.status import LogLine
from text.i18n import _
from text.plain import plain
from tui.log_view.choice import Choice
from tui.log_view.filter import LogFilter
from tui.log_view.index import LogIndex
from tui.log_view.paint import RowPainter
from tui.log_view.palette import PALETTE_CLASSES, PALETTE_CSS, palette_of
from tui.log_view.ring import Entry, LogRing
from tui.log_view.rows import Columns, columns_for, gutter_texts, text_of
from tui.log_view.tail import TailView

if TYPE_CHECKING:
    from textual.events import Resize
    from textual.selection import Selection

SHIFT_CELLS = 16
LEAST_TEXT = 8


class LogLines(TailView):
    """Shows what its filter lets through of the lines appended.

    `file_of` gives the path of the file with all lines of a node, "" if it is not known.
    """

    COMPONENT_CLASSES: ClassVar[set[str]] = PALETTE_CLASSES
    DEFAULT_CSS = f"""
    LogLines {{
        background: $surface;
        color: $foreground;
        &:focus {{ background-tint: $foreground 4%; }}
        {PALETTE_CSS}
    }}
    """

    def __init__(
        self,
        *,
        max_lines: int = 20_000,
        fold: bool = True,
        period_s: float = 0.1,
        file_of: Callable[[str], str] = lambda _node: "",
        id: str | None = None,
        classes: str | None = None,
    ) -> None:
        """Keep so many lines; draw at most every `period_s`."""
        super().__init__(period_s, id=id, classes=classes)
        self.file_of = file_of
        self.ring = LogRing(max_lines)
        self.index = LogIndex(self._text_of)
        self.fold = fold
        self.fresh = 0
        """Lines shown that have come since following ended."""
        self.empty_words = ""
        """Why no line has come; in place of "no lines yet"."""
        self.minimum_words = ""
        """How the bar calls lines above the lowest severity; in place of "WARN and worse"."""
        self.choice = Choice()
        self._shift = 0
        self._node_places: dict[str, int] = {}
        self._longest_node = 4
        self._columns = Columns(0, 0, 0)
        self._painter: RowPainter | None = None
        self._strips: LRUCache[tuple[int, int], Strip] = LRUCache(512)

    def append(self, lines: Sequence[LogLine], skipped: Mapping[str, int] | None = None) -> None:
        """Take lines in the order they came in, and how many were skipped of which node."""
        entries = self.ring.append(lines, skipped or {})
        self.know_nodes(dict.fromkeys(entry.node for entry in entries))
        shown = self.index.extend(entries)
        self.fresh += 0 if self.following else shown
        if self.ring.full:
            self.index.prune(self.ring.trim())
        self.rows_came()

    def know_nodes(self, names: Iterable[str]) -> None:
        """Give these nodes their colours, in this order."""
        for name in names:
            self._node_places.setdefault(name, len(self._node_places))
        longest = max(map(len, self._node_places), default=0)
        if longest > self._longest_node:
            self._longest_node = longest
            self.lay_out()

    def clear(self) -> None:
        """Forget every line."""
        self.ring.clear()
        self.index.rebuild(())
        self.follow()

    @property
    def log_filter(self) -> LogFilter:
        """Which lines are shown."""
        return self.index.filter

    @log_filter.setter
    def log_filter(self, chosen: LogFilter) -> None:
        if chosen != self.index.filter:
            top = self._top_id()
            self.index.filter = chosen
            self.index.rebuild(self.ring.entries)
            self._settle(top)

    def set_fold(self, fold: bool) -> None:
        """Fold long lines, or show one row of each and shift it sideways."""
        if fold != self.fold:
            self.fold, self._shift = fold, 0
            self.lay_out()

    def follow(self) -> None:
        """Keep the newest line in sight from now on."""
        self.fresh = 0
        self.ring.release()
        super().follow()

    def pause(self) -> None:
        """Stand still: no line that is here now is dropped while lines come in."""
        if self.following:
            self.fresh = 0
            self.ring.hold()
        super().pause()

    @property
    def total_rows(self) -> int:
        """Rows of the lines shown."""
        return self.index.rows

    def lay_out(self) -> None:
        """Fit columns and folding to the size and the language."""
        if self._row_width < 1:
            return
        top = self._top_id()
        self._columns = self.columns_for(self._row_width, self._longest_node)
        self.index.fold(self._text_width if self.fold else None)
        self._settle(top)

    def cuts(self, node: str) -> bool:
        """Whether its column has no room for the name of this node."""
        return cell_len(plain(node)) > self._columns.node

    def columns_for(self, width: int, longest_node: int) -> Columns:
        """Which columns stand in front of the text, for rows of so many cells."""
        return columns_for(width, longest_node)

    @property
    def _row_width(self) -> int:
        return self.container_size.width - self.scrollbar_size_vertical

    @property
    def _text_width(self) -> int:
        return max(LEAST_TEXT, self._row_width - self._columns.gutter)

    def _settle(self, top: int | None) -> None:
        """After rows have changed: the same line at the top, unless the end is followed."""
        self.repaint()
        if not self.following and top is not None:
            self.steer(self.index.row_of(self.index.place_of(top)))
        self.redraw()

    def repaint(self) -> None:
        """Draw rows anew: they look different."""
        self._painter = None
        self._strips.clear()
        self.refresh()

    def _top_id(self) -> int | None:
        place = self.index.locate(int(self.scroll_y))[0]
        return self.index.shown[place].id if place < len(self.index.shown) else None

    def _on_resize(self, _event: Resize) -> None:
        self.lay_out()

    def notify_style_update(self) -> None:
        """Take the colours anew."""
        super().notify_style_update()
        self._painter = None
        self._strips.clear()

    def action_scroll_left(self) -> None:
        """Shift lines that are not folded."""
        self._shift_to(self._shift - SHIFT_CELLS)

    def action_scroll_right(self) -> None:
        """Shift lines that are not folded."""
        self._shift_to(self._shift + SHIFT_CELLS)

    def _shift_to(self, shift: int) -> None:
        most = 0 if self.fold else max(0, self.index.longest - self._text_width)
        shift = max(0, min(shift, most))
        if shift != self._shift:
            self._shift = shift
            self.repaint()

    def render_line(self, y: int) -> Strip:
        """One row, or words where there is no line."""
        row, width = int(self.scroll_y) + y, self.size.width
        if row >= self.index.rows:
            return (
                self._words_line(y) if not self.index.rows else Strip.blank(width, self.rich_style)
            )
        place, part = self.index.locate(row)
        entry = self.index.shown[place]
        selection = self.text_selection
        strip = None if selection else self._strips.get((entry.id, part))
        if strip is None:
            strip = self._draw(entry, part, selection)
            if selection is None:
                self._strips[entry.id, part] = strip
        return strip

    def _draw(self, entry: Entry, part: int, selection: Selection | None) -> Strip:
        painter = self._painter
        if painter is None:
            painter = self._painter = RowPainter(
                palette_of(self),
                self._columns,
                self._text_width,
                self._shift,
                self.fold,
                self.log_filter.pattern,
            )
        node_style = painter.palette.node(self._node_places[entry.node])
        strip = painter.row(
            entry,
            part,
            self._text_of(entry),
            node_style,
            selection,
            chosen=entry.id in self.choice,
        )
        return strip.adjust_cell_length(self.size.width, self.rich_style)

    def row_text(self, entry: Entry) -> str:
        """Columns and text of a line as they are drawn, unfolded."""
        return "".join(gutter_texts(entry, self._columns)) + self._text_of(entry)

    def _text_of(self, entry: Entry) -> str:
        return text_of(entry, self.file_of(entry.node)) if entry.skipped else entry.text

    def _words_line(self, y: int) -> Strip:
        words = self.empty_words or _("no lines yet")
        if self.ring.entries:
            words = _("no line of {count} passes the filter").format(count=len(self.ring.entries))
        style = self.get_component_rich_style("log--muted")
        strip = Strip([Segment(f" {words}", style)]) if y == 0 else Strip([])
        return strip.adjust_cell_length(self.size.width, self.rich_style)

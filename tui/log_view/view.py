"""The log as the user works with it: scrolling, choosing lines, searching.

The filter examines each line once, on arrival; only rows on screen are ever drawn. Choosing,
searching and scrolling up pause the view; End follows again.
"""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import ClassVar, TypeAlias

from rich.cells import cell_len
from rich.segment import Segment
from textual.binding import Binding, BindingType
from textual.cache import LRUCache
from textual.events import Click, Resize
from textual.message import Message
from textual.scroll_view import ScrollView
from textual.selection import Selection
from textual.strip import Strip
from textual.widget import Widget

from launcher.status import LogLine
from text.i18n import _
from text.plain import plain
from tui.log_view.index import LineChoice, LineRing, LogEntry, LogFilter, LogIndex
from tui.log_view.rows import (
    PALETTE_CLASSES,
    PALETTE_CSS,
    LogColumns,
    RowPainter,
    columns_for,
    exported,
    gutter_texts,
    text_of,
)
from tui.log_view.tail import Tail
from tui.session.past import KEPT_LINES
from tui.widgets.words import OneStyle

ColumnsFor: TypeAlias = "Callable[[int, int], LogColumns]"
"""Returns the columns in front of the text, for the given widths of a row and the longest node."""
SHIFT_CELLS = 16
LEAST_TEXT = 8
PAGES_KEPT = 2
"""Drawn rows that are kept, in heights of the view: a row takes two kilobytes."""


class LogView(OneStyle, ScrollView, can_focus=True):
    """Shows those of the appended lines that pass its filter.

    Up and down choose a line, with Shift several. `ring` keeps the lines, `index` knows which of
    them are shown, on which rows, and which match the search, `choice` knows the chosen ones.
    """

    ALLOW_SELECT = True
    COMPONENT_CLASSES: ClassVar[set[str]] = PALETTE_CLASSES
    DEFAULT_CSS = f"""
    LogView {{
        height: 1fr;
        width: 1fr;
        overflow-x: hidden;
        overflow-y: scroll;
        scrollbar-size-vertical: 1;
        background: $surface;
        color: $foreground;
        &:focus {{ background-tint: $foreground 4%; }}
        {PALETTE_CSS}
    }}
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("home", "scroll_home", show=False),
        Binding("end", "scroll_end", show=False),
        Binding("shift+up", "choose(-1)", show=False),
        Binding("shift+down", "choose(1)", show=False),
        Binding("escape", "let_go", show=False),
    ]

    class StateChanged(Message):
        """The rows have changed, or the filter, following, search or choice."""

        def __init__(self, view: LogView) -> None:
            super().__init__()
            self.view = view

        @property
        def control(self) -> Widget:
            return self.view

        def can_replace(self, message: Message) -> bool:
            """Of several, only the newest is needed."""
            return isinstance(message, LogView.StateChanged) and message.view is self.view

    def __init__(
        self,
        *,
        max_lines: int = KEPT_LINES,
        fold: bool = True,
        period_s: float = 0.1,
        columns_for: ColumnsFor = columns_for,
        file_of: Callable[[str], str] = lambda _node: "",
    ) -> None:
        """Keep this many lines; draw at most every `period_s`.

        `file_of` returns the path of the file with all lines of a node, "" if it is not known.
        """
        super().__init__()
        self.ring = LineRing(max_lines)
        self.index = LogIndex(lambda entry: text_of(entry, file_of(entry.node)) if entry.skipped else entry.text)
        self.fresh = 0
        """Shown lines that have arrived since following ended."""
        self.empty_words = ""
        """Why there are no lines, in place of "no lines yet"."""
        self.minimum_words = ""
        """How the bar describes the lowest severity shown, in place of "WARN and worse"."""
        self.choice = LineChoice(self.index)
        self._tail = Tail(self, lambda: self.index.rows, self._tell, period_s)
        self.fold = fold
        """Whether long lines are wrapped; set it by `set_fold`."""
        self._shifted = 0
        """Cells by which unwrapped lines are shifted to the left."""
        self._columns_for, self._columns = columns_for, LogColumns(0, 0, 0)
        self._node_places: dict[str, int] = {}
        self._longest_node = 4
        self._painter: RowPainter | None = None
        self._strips: LRUCache[tuple[int, int], Strip] = LRUCache(1)

    # Display

    def append(self, lines: Sequence[LogLine], skipped: Mapping[str, int] | None = None) -> None:
        """Add lines in order of arrival, and the numbers of skipped lines by node."""
        entries = self.ring.append(lines, skipped or {})
        self.know_nodes(dict.fromkeys(entry.node for entry in entries))
        shown = self.index.extend(entries)
        self.fresh += 0 if self.following else shown
        if self.ring.full:
            self.ring.trim()
            self.index.rebuild(self.ring.entries)
        self._tail.rows_came()

    def know_nodes(self, names: Iterable[str]) -> None:
        for name in names:
            self._node_places.setdefault(name, len(self._node_places))
        longest = max(map(len, self._node_places), default=0)
        if longest > self._longest_node:
            self._longest_node = longest
            self.lay_out()

    def clear(self) -> None:
        self.ring.clear()
        self.index.rebuild(())
        self.follow()

    def replace_lines(self, lines: Sequence[LogLine]) -> None:
        """Replace all lines; a paused view stays paused."""
        following = self.following
        self.clear()
        self.append(lines)
        if not following:
            self.pause()

    @property
    def log_filter(self) -> LogFilter:
        return self.index.filter

    @log_filter.setter
    def log_filter(self, chosen: LogFilter) -> None:
        if chosen != self.index.filter:
            top = self.top_id
            self.index.filter = chosen
            self.index.rebuild(self.ring.entries)
            self._settle(top)

    def set_fold(self, fold: bool) -> None:
        if fold != self.fold:
            self.fold, self._shifted = fold, 0
            self.lay_out()

    def cuts(self, node: str) -> bool:
        """Whether the column has no room for the name of this node."""
        return cell_len(plain(node)) > self._columns.node

    # Following

    @property
    def following(self) -> bool:
        return self._tail.following

    def follow(self) -> None:
        """Keep the newest line in sight from now on, with no line chosen."""
        if self.choice.cursor is not None:
            self.choice.clear()
            self._repaint()
        self.fresh = 0
        self.ring.release()
        self._tail.following = True
        self._tail.redraw()

    def pause(self) -> None:
        """Pause: keep all lines that are present now while others arrive."""
        if self.following:
            self.fresh = 0
            self.ring.hold()
            self._tail.following = False
            self._tell()

    def toggle_following(self) -> None:
        if self.following:
            self.pause()
        else:
            self.follow()

    def watch_scroll_y(self, old_value: float, new_value: float) -> None:
        """Pause when scrolled away from the end; follow when scrolled back to it."""
        if self._tail.steering:
            return
        super().watch_scroll_y(old_value, new_value)
        self._tail.sync_scrollbar()
        if new_value < self.max_scroll_y:
            self.pause()
        elif new_value > old_value and not self.following:
            self.follow()

    def action_page_up(self) -> None:
        self.scroll_to(y=self.scroll_y - self._tail.page_rows, animate=False)

    def action_page_down(self) -> None:
        self.scroll_to(y=self.scroll_y + self._tail.page_rows, animate=False)

    def action_scroll_home(self) -> None:
        self.scroll_to(y=0, animate=False)

    def action_scroll_end(self) -> None:
        self.follow()

    # Choosing and searching

    def find(self, step: int) -> bool:
        shown = self.index.shown
        if not shown:
            return False
        start = self.choice.cursor
        if start is None:
            start = shown[self._place_on_row(0 if step > 0 else self._tail.page_rows - 1)].id - step
        found = self.index.found_near(start, step)
        if found is None:
            return False
        self._point_at(self.index.place_of(found))
        return True

    def chosen_lines(self) -> list[str]:
        return exported(self.choice.entries, self.index)

    def shown_lines(self) -> list[str]:
        return exported(self.index.shown, self.index)

    def action_scroll_up(self) -> None:
        self._step(-1, extend=False)

    def action_scroll_down(self) -> None:
        self._step(1, extend=False)

    def action_choose(self, step: int) -> None:
        self._step(step, extend=True)

    def action_let_go(self) -> None:
        self.choice.clear()
        self._repaint()
        self._tell()

    def action_scroll_left(self) -> None:
        self._shift(-SHIFT_CELLS)

    def action_scroll_right(self) -> None:
        self._shift(SHIFT_CELLS)

    def on_click(self, event: Click) -> None:
        row = int(self.scroll_y) + event.y
        if self.text_selection is None and row < self.index.rows:
            self._point_at(self.index.locate(row)[0], extend=event.shift)

    def selection_updated(self, selection: Selection | None) -> None:
        if selection is not None:
            self.pause()
        self.refresh()

    def get_selection(self, selection: Selection) -> tuple[str, str] | None:
        """The text selected with the mouse: what the rows show, with wrapped lines joined."""
        ids = [self.index.shown[0].id, self.index.shown[-1].id] if self.index.shown else [0, -1]
        first = ids[0] if selection.start is None else selection.start.y
        last = ids[1] if selection.end is None else selection.end.y
        start, end = self.index.place_of(first), self.index.place_of(last + 1)
        lines = []
        for entry in self.index.shown[start:end]:
            span = selection.get_span(entry.id)
            if span is not None:
                text = "".join(gutter_texts(entry, self._columns)) + self.index.text_of(entry)
                lines.append(text[span[0] : len(text) if span[1] < 0 else span[1]])
        return ("\n".join(lines), "\n") if lines else None

    def _step(self, step: int, *, extend: bool) -> None:
        if self.choice.cursor is not None:
            place = self.index.place_of(self.choice.cursor) + step
        else:
            place = self._place_on_row(self._tail.page_rows - 1)
        self._point_at(place, extend=extend)

    def _place_on_row(self, y: int) -> int:
        """Index of the line on this row of the screen, or of the last one above it."""
        row = min(int(self.scroll_y) + y, self.index.rows - 1)
        return self.index.locate(row)[0] if row >= 0 else 0

    def _point_at(self, place: int, *, extend: bool = False) -> None:
        shown = self.index.shown
        if not shown:
            return
        self.pause()
        place = max(0, min(place, len(shown) - 1))
        self.choice.move(shown[place].id, extend=extend)
        self._tail.show(self.index.row_of(place), self.index.row_of(place + 1))
        self._repaint()
        self._tell()

    def _shift(self, cells: int) -> None:
        most = 0 if self.fold else max(0, self.index.longest - self._text_width)
        shift = max(0, min(self._shifted + cells, most))
        if shift != self._shifted:
            self._shifted = shift
            self._repaint()

    def _tell(self) -> None:
        self.post_message(self.StateChanged(self))

    # Drawing

    @property
    def top_id(self) -> int | None:
        place = self.index.locate(int(self.scroll_y))[0]
        return self.index.shown[place].id if place < len(self.index.shown) else None

    def lay_out(self) -> None:
        width = self.container_size.width - self.scrollbar_size_vertical
        if width >= 1:
            top = self.top_id
            self._strips.maxsize = max(1, PAGES_KEPT * self.container_size.height)
            self._columns = self._columns_for(width, self._longest_node)
            self.index.fold(self._text_width if self.fold else None)
            self._settle(top)

    @property
    def _text_width(self) -> int:
        width = self.container_size.width - self.scrollbar_size_vertical
        return max(LEAST_TEXT, width - self._columns.gutter)

    def _on_resize(self, _event: Resize) -> None:
        self.lay_out()

    def notify_style_update(self) -> None:
        super().notify_style_update()
        self._forget()

    def _settle(self, top: int | None) -> None:
        """After rows have changed, keep the same line at the top, or follow the end."""
        self._repaint()
        if not self.following and top is not None:
            self._tail.steer(self.index.row_of(self.index.place_of(top)))
        self._tail.redraw()

    def _forget(self) -> None:
        self._painter = None
        self._strips.clear()

    def _repaint(self) -> None:
        self._forget()
        self.refresh()

    def render_line(self, y: int) -> Strip:
        row = int(self.scroll_y) + y
        if row < self.index.rows:
            place, part = self.index.locate(row)
            return self._row(self.index.shown[place], part)
        strip = Strip([]) if self.index.rows else self._words_line(y)
        return strip.adjust_cell_length(self.size.width, self.rich_style)

    def _row(self, entry: LogEntry, part: int) -> Strip:
        selection = self.text_selection
        strip = None if selection else self._strips.get((entry.id, part))
        if strip is not None:
            return strip
        if self._painter is None:
            self._painter = RowPainter(self, self.index, self._columns, self._text_width, self._shifted)
        place, chosen = self._node_places[entry.node], entry.id in self.choice
        strip = self._painter.row(entry, part, place, selection, chosen=chosen)
        strip = strip.adjust_cell_length(self.size.width, self.rich_style)
        if selection is None:
            self._strips[entry.id, part] = strip
        return strip

    def _words_line(self, y: int) -> Strip:
        words = self.empty_words or _("no lines yet")
        if self.ring.entries:
            words = _("no line of {count} passes the filter").format(count=len(self.ring.entries))
        lines = textwrap.wrap(words, max(1, self.size.width - 2))
        style = self.get_component_rich_style("log--muted")
        return Strip([Segment(f" {lines[y]}", style)] if y < len(lines) else [])

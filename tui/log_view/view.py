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
from textual.events import Click, Resize
from textual.geometry import Size
from textual.message import Message
from textual.scroll_view import ScrollView
from textual.selection import Selection
from textual.strip import Strip
from textual.widget import Widget

from launcher.status import LogLine
from text.i18n import _
from text.plain import plain
from tui.log_view.index import LineChoice, LineRing, LogFilter, LogIndex
from tui.log_view.rows import PALETTE_CLASSES, PALETTE_CSS, LogColumns, RowPainter, columns_for, selected, text_of
from tui.session.past import KEPT_LINES
from tui.widgets.words import OneStyle

ColumnsFor: TypeAlias = "Callable[[int, int], LogColumns]"
"""Returns the columns in front of the text, for the given widths of a row and the longest node."""
SHIFT_CELLS = 16
LEAST_TEXT = 8


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
        self.following = True
        """Whether the newest line is kept in sight."""
        self._steering = False
        """Whether the view itself is scrolling, rather than the user."""
        self._period_s, self._waiting = period_s, False
        self._thumb = (-1, -1)
        self.fold = fold
        """Whether long lines are wrapped; set it by `set_fold`."""
        self._shifted = 0
        """Cells by which unwrapped lines are shifted to the left."""
        self._columns_for, self._columns = columns_for, LogColumns(0, 0, 0)
        self._node_places: dict[str, int] = {}
        self._longest_node = 4
        self._painter: RowPainter | None = None

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
        self._rows_came()

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

    def follow(self) -> None:
        """Keep the newest line in sight from now on, with no line chosen."""
        if self.choice.cursor is not None:
            self.choice.clear()
            self._repaint()
        self.fresh = 0
        self.ring.release()
        self.following = True
        self._redraw()

    def pause(self) -> None:
        """Pause: keep all lines that are present now while others arrive."""
        if self.following:
            self.fresh = 0
            self.ring.hold()
            self.following = False
            self._tell()

    def watch_scroll_y(self, old_value: float, new_value: float) -> None:
        """Pause when scrolled away from the end; follow when scrolled back to it."""
        if self._steering:
            return
        super().watch_scroll_y(old_value, new_value)
        self._sync_scrollbar()
        if new_value < self.max_scroll_y:
            self.pause()
        elif new_value > old_value and not self.following:
            self.follow()

    def action_page_up(self) -> None:
        self.scroll_to(y=self.scroll_y - self._page_rows, animate=False)

    def action_page_down(self) -> None:
        self.scroll_to(y=self.scroll_y + self._page_rows, animate=False)

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
            start = shown[self._place_on_row(0 if step > 0 else self._page_rows - 1)].id - step
        found = self.index.found_near(start, step)
        if found is None:
            return False
        self._point_at(self.index.place_of(found))
        return True

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
        return selected(selection, self.index, self._columns)

    def _step(self, step: int, *, extend: bool) -> None:
        if self.choice.cursor is not None:
            place = self.index.place_of(self.choice.cursor) + step
        else:
            place = self._place_on_row(self._page_rows - 1)
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
        first, end = self.index.row_of(place), self.index.row_of(place + 1)
        if first < self.scroll_y or end - first > self._page_rows:
            self._steer(first)
        elif end > self.scroll_y + self._page_rows:
            self._steer(end - self._page_rows)
        self._sync_scrollbar()
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

    # Drawing. Growing needs no layout: the scrollbar is always there, and it is redrawn only when its thumb would
    # look different.

    @property
    def _page_rows(self) -> int:
        return self.container_size.height

    def _rows_came(self) -> None:
        """Draw soon, together with rows that arrive until then; draw the first rows at once."""
        if self._waiting:
            return
        if self._period_s and self.is_running and self.virtual_size.height:
            self._waiting = True
            self.set_timer(self._period_s, self._draw_those_that_came)
        else:
            self._draw_those_that_came()

    def _draw_those_that_came(self) -> None:
        self._waiting = False
        self._redraw(only_end=not self.following and self.index.rows >= self.virtual_size.height)

    def _redraw(self, *, only_end: bool = False) -> None:
        had = self.virtual_size.height
        # Set without the reactive: its watcher would lay out the whole screen for each batch.
        self.set_reactive(Widget.virtual_size, Size(self.container_size.width, self.index.rows))
        self._steer(self.max_scroll_y if self.following else int(self.scroll_y))
        if not only_end or had < self.scroll_y + self._page_rows:
            self.refresh()
        self._sync_scrollbar()
        self._tell()

    def _steer(self, row: int) -> None:
        """Put this row at the top without treating it as the user's scrolling; does not draw."""
        self._steering = True
        self.scroll_target_y = self.scroll_y = row
        self._steering = False

    def _sync_scrollbar(self) -> None:
        """Update the thumb if it would differ by an eighth of a cell."""
        if not self.show_vertical_scrollbar:
            return
        total, page = max(1, self.index.rows), self._page_rows
        thumb = (round(8 * page * self.scroll_y / total), round(8 * page * page / total))
        if thumb != self._thumb:
            self._thumb, bar = thumb, self.vertical_scrollbar
            bar.window_virtual_size, bar.window_size = total, page
            bar.position = self.scroll_y

    @property
    def top_id(self) -> int | None:
        place = self.index.locate(int(self.scroll_y))[0]
        return self.index.shown[place].id if place < len(self.index.shown) else None

    def lay_out(self) -> None:
        width = self.container_size.width - self.scrollbar_size_vertical
        if width >= 1:
            top = self.top_id
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
        self._painter = None

    def _settle(self, top: int | None) -> None:
        """After rows have changed, keep the same line at the top, or follow the end."""
        self._repaint()
        if not self.following and top is not None:
            self._steer(self.index.row_of(self.index.place_of(top)))
        self._redraw()

    def _repaint(self) -> None:
        self._painter = None
        self.refresh()

    def render_line(self, y: int) -> Strip:
        row = int(self.scroll_y) + y
        if row < self.index.rows:
            if self._painter is None:
                self._painter = RowPainter(self, self.index, self._columns, self._text_width, self._shifted)
            place, part = self.index.locate(row)
            entry = self.index.shown[place]
            chosen = entry.id in self.choice
            return self._painter.strip(entry, part, self._node_places[entry.node], self.text_selection, chosen=chosen)
        strip = Strip([]) if self.index.rows else self._words_line(y)
        return strip.adjust_cell_length(self.size.width, self.rich_style)

    def _words_line(self, y: int) -> Strip:
        words = self.empty_words or _("no lines yet")
        if self.ring.entries:
            words = _("no line of {count} passes the filter").format(count=len(self.ring.entries))
        lines = textwrap.wrap(words, max(1, self.size.width - 2))
        style = self.get_component_rich_style("log--muted")
        return Strip([Segment(f" {lines[y]}", style)] if y < len(lines) else [])

"""The log as a person works with it: point at lines, choose, search, copy.

Pointing, searching and scrolling up pause the view; End follows again.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.binding import Binding, BindingType

from tui.log_view.choice import exported
from tui.log_view.lines import LogLines

if TYPE_CHECKING:
    from collections.abc import Iterable

    from textual.events import Click
    from textual.selection import Selection

    from tui.log_view.ring import Entry


class LogView(LogLines):
    """Lines of many nodes; up and down point at lines, with shift they choose several."""

    ALLOW_SELECT = True
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("shift+up", "choose(-1)", show=False),
        Binding("shift+down", "choose(1)", show=False),
        Binding("escape", "let_go", show=False),
    ]

    def follow(self) -> None:
        """Keep the newest line in sight, nothing chosen."""
        if self.choice.cursor is not None:
            self.choice.clear()
            self.repaint()
        super().follow()

    def action_scroll_up(self) -> None:
        """Point at the line above."""
        self._step(-1, extend=False)

    def action_scroll_down(self) -> None:
        """Point at the line below."""
        self._step(1, extend=False)

    def action_choose(self, step: int) -> None:
        """Choose one line more, upwards (-1) or downwards (1)."""
        self._step(step, extend=True)

    def action_let_go(self) -> None:
        """Choose nothing."""
        self.choice.clear()
        self.repaint()
        self.post_message(self.Changed(self))

    def _step(self, step: int, *, extend: bool) -> None:
        if self.choice.cursor is not None:
            place = self.index.place_of(self.choice.cursor) + step
        else:
            place = self._place_on_row(self.page_rows - 1)
        self._point_at(place, extend=extend)

    def _place_on_row(self, y: int) -> int:
        """Place of the line on this row of the screen, or of the last above it."""
        row = min(int(self.scroll_y) + y, self.total_rows - 1)
        return self.index.locate(row)[0] if row >= 0 else 0

    def _point_at(self, place: int, *, extend: bool = False) -> None:
        shown = self.index.shown
        if not shown:
            return
        self.pause()
        place = max(0, min(place, len(shown) - 1))
        self.choice.move(shown[place].id, extend=extend)
        first, end = self.index.row_of(place), self.index.row_of(place + 1)
        if first < self.scroll_y or end - first > self.page_rows:
            self.steer(first)
        elif end > self.scroll_y + self.page_rows:
            self.steer(end - self.page_rows)
        self.sync_scrollbar()
        self.repaint()
        self.post_message(self.Changed(self))

    def on_click(self, event: Click) -> None:
        """Point at the line that was clicked; with shift choose all up to it."""
        row = int(self.scroll_y) + event.y
        if self.text_selection is None and row < self.total_rows:
            self._point_at(self.index.locate(row)[0], extend=event.shift)

    def selection_updated(self, selection: Selection | None) -> None:
        """Stand still while text is selected by the mouse."""
        if selection is not None:
            self.pause()
        self.refresh()

    def get_selection(self, selection: Selection) -> tuple[str, str] | None:
        """Text that the mouse has selected: what the rows show, folded lines in one piece."""
        ids = [self.index.shown[0].id, self.index.shown[-1].id] if self.index.shown else [0, -1]
        first = ids[0] if selection.start is None else selection.start.y
        last = ids[1] if selection.end is None else selection.end.y
        start, end = self.index.place_of(first), self.index.place_of(last + 1)
        lines = []
        for entry in self.index.shown[start:end]:
            span = selection.get_span(entry.id)
            if span is not None:
                text = self.row_text(entry)
                lines.append(text[span[0] : len(text) if span[1] < 0 else span[1]])
        return ("\n".join(lines), "\n") if lines else None

    def find(self, step: int) -> bool:
        """Point at the next (1) or previous (-1) line that holds the text searched for."""
        shown = self.index.shown
        if not shown:
            return False
        start = self.choice.cursor
        if start is None:
            start = shown[self._place_on_row(0 if step > 0 else self.page_rows - 1)].id - step
        found = self.index.found_near(start, step)
        if found is None:
            return False
        self._point_at(self.index.place_of(found))
        return True

    @property
    def found_number(self) -> int:
        """Which of the found lines is pointed at, from 1; 0 if none is."""
        return self.index.found_number(self.choice.cursor)

    @property
    def chosen_count(self) -> int:
        """How many of the lines shown are chosen."""
        return len(self._chosen())

    @property
    def chosen_node(self) -> str | None:
        """Node of the line pointed at, None if none is."""
        cursor = self.choice.cursor
        found = [entry.node for entry in self._chosen() if entry.id == cursor]
        return found[0] if found else None

    def _chosen(self) -> list[Entry]:
        span = self.choice.span
        if span is None:
            return []
        first, end = self.index.place_of(span[0]), self.index.place_of(span[1] + 1)
        return self.index.shown[first:end]

    def chosen_lines(self) -> list[str]:
        """The lines chosen, as text with date, severity and node."""
        return self._exported(self._chosen())

    def shown_lines(self) -> list[str]:
        """All lines that the filter lets through, likewise."""
        return self._exported(self.index.shown)

    def _exported(self, entries: Iterable[Entry]) -> list[str]:
        return [exported(entry, self._text_of(entry)) for entry in entries]

"""Keeps a growing view of rows at the newest one until the user scrolls back.

Growing needs no layout: the scrollbar is always there, and it is redrawn only when its thumb would
look different.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from textual.geometry import Size
from textual.widget import Widget

if TYPE_CHECKING:
    from textual.scroll_view import ScrollView


class Tail:
    """Scrolls and draws a scroll view with `total_rows` rows.

    `on_drawn` is called whenever rows have been added or moved.
    """

    def __init__(
        self, view: ScrollView, total_rows: Callable[[], int], on_drawn: Callable[[], object], period_s: float
    ) -> None:
        """Start at the end, following it; new rows are drawn within `period_s`."""
        self.following = True
        """Whether to keep the newest row in sight."""
        self.steering = False
        """Whether the tail itself is scrolling, rather than the user."""
        self._view = view
        self._total_rows = total_rows
        self._on_drawn = on_drawn
        self._period_s = period_s
        self._waiting = False
        self._thumb = (-1, -1)

    @property
    def page_rows(self) -> int:
        return self._view.container_size.height

    def rows_came(self) -> None:
        """Draw soon, together with rows that arrive until then; draw the first rows at once."""
        if self._waiting:
            return
        if self._period_s and self._view.is_running and self._view.virtual_size.height:
            self._waiting = True
            self._view.set_timer(self._period_s, self._draw_those_that_came)
        else:
            self._draw_those_that_came()

    def _draw_those_that_came(self) -> None:
        self._waiting = False
        had = self._view.virtual_size.height
        self.redraw(only_end=not self.following and self._total_rows() >= had)

    def redraw(self, *, only_end: bool = False) -> None:
        view = self._view
        had = view.virtual_size.height
        # Set without the reactive: its watcher would lay out the whole screen for each batch.
        size = Size(view.container_size.width, self._total_rows())
        view.set_reactive(Widget.virtual_size, size)
        self.steer(view.max_scroll_y if self.following else int(view.scroll_y))
        if not only_end or had < view.scroll_y + self.page_rows:
            view.refresh()
        self.sync_scrollbar()
        self._on_drawn()

    def steer(self, row: int) -> None:
        """Put this row at the top without treating it as the user's scrolling; does not draw."""
        self.steering = True
        self._view.scroll_target_y = self._view.scroll_y = row
        self.steering = False

    def show(self, first: int, end: int) -> None:
        if first < self._view.scroll_y or end - first > self.page_rows:
            self.steer(first)
        elif end > self._view.scroll_y + self.page_rows:
            self.steer(end - self.page_rows)
        self.sync_scrollbar()

    def sync_scrollbar(self) -> None:
        """Update the thumb if it would differ by an eighth of a cell."""
        view = self._view
        if not view.show_vertical_scrollbar:
            return
        total, page = max(1, self._total_rows()), self.page_rows
        thumb = (round(8 * page * view.scroll_y / total), round(8 * page * page / total))
        if thumb != self._thumb:
            self._thumb = thumb
            bar = view.vertical_scrollbar
            bar.window_virtual_size, bar.window_size = total, page
            bar.position = view.scroll_y

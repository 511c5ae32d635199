"""A view of rows that grow at their end: it follows the newest until somebody looks back.

Growing costs no layout: the scrollbar is always there, and it is drawn again only when its thumb
would look different.
"""

from __future__ import annotations

from typing import ClassVar

from textual.binding import Binding, BindingType
from textual.geometry import Size
from textual.message import Message
from textual.scroll_view import ScrollView
from textual.widget import Widget

from tui.widgets.one_style import OneStyle


class TailView(OneStyle, ScrollView, can_focus=True):
    """Base of views with `total_rows` rows; draws rows that come after `period_s`."""

    DEFAULT_CSS = """
    TailView {
        height: 1fr;
        width: 1fr;
        overflow-x: hidden;
        overflow-y: scroll;
        scrollbar-size-vertical: 1;
    }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("home", "scroll_home", show=False),
        Binding("end", "scroll_end", show=False),
    ]

    class Changed(Message):
        """Rows have come, or what is shown, followed, found or chosen is not what it was."""

        def __init__(self, view: TailView) -> None:
            """Name the view."""
            super().__init__()
            self.view = view

        @property
        def control(self) -> Widget:
            """The view."""
            return self.view

        def can_replace(self, message: Message) -> bool:
            """Of many, the newest is enough."""
            return isinstance(message, TailView.Changed) and message.view is self.view

    def __init__(self, period_s: float, id: str | None = None, classes: str | None = None) -> None:
        """Begin at the end, following it."""
        super().__init__(id=id, classes=classes)
        self.following = True
        self._period_s = period_s
        self._waiting = False
        self._steering = False
        self._thumb = (-1, -1)

    @property
    def total_rows(self) -> int:
        """How many rows there are."""
        raise NotImplementedError

    @property
    def page_rows(self) -> int:
        """How many rows are on screen."""
        return self.container_size.height

    def follow(self) -> None:
        """Keep the newest row in sight from now on."""
        self.following = True
        self.redraw()

    def pause(self) -> None:
        """Stand still while rows come."""
        if self.following:
            self.following = False
            self.post_message(self.Changed(self))

    def toggle_following(self) -> None:
        """Pause, or follow again."""
        if self.following:
            self.pause()
        else:
            self.follow()

    def rows_came(self) -> None:
        """Draw soon, together with what comes until then; the first rows of all at once."""
        if self._waiting:
            return
        if self._period_s and self.is_running and self.virtual_size.height:
            self._waiting = True
            self.set_timer(self._period_s, self._rows_came)
        else:
            self._rows_came()

    def _rows_came(self) -> None:
        self._waiting = False
        had = self.virtual_size.height
        self.redraw(only_end=not self.following and self.total_rows >= had)

    def redraw(self, *, only_end: bool = False) -> None:
        """Draw; with `only_end` nothing but rows that came into sight below the others."""
        had = self.virtual_size.height
        # Assigned past the reactive: its watcher would lay out the whole screen for each batch.
        self.set_reactive(Widget.virtual_size, Size(self.container_size.width, self.total_rows))
        self.steer(self.max_scroll_y if self.following else int(self.scroll_y))
        if not only_end or had < self.scroll_y + self.page_rows:
            self.refresh()
        self.sync_scrollbar()
        self.post_message(self.Changed(self))

    def steer(self, row: int) -> None:
        """Put this row at the top without that counting as somebody's wish; not drawn yet."""
        self._steering = True
        self.scroll_target_y = self.scroll_y = row
        self._steering = False

    def sync_scrollbar(self) -> None:
        """Make the thumb fit, if it would look different by an eighth of a cell."""
        if not self.show_vertical_scrollbar:
            return
        total, page = max(1, self.total_rows), self.page_rows
        thumb = (round(8 * page * self.scroll_y / total), round(8 * page * page / total))
        if thumb != self._thumb:
            self._thumb = thumb
            bar = self.vertical_scrollbar
            bar.window_virtual_size, bar.window_size = total, page
            bar.position = self.scroll_y

    def watch_scroll_y(self, old_value: float, new_value: float) -> None:
        """Leave the end: pause. Come back to it: follow."""
        if self._steering:
            return
        super().watch_scroll_y(old_value, new_value)
        self.sync_scrollbar()
        if new_value < self.max_scroll_y:
            self.pause()
        elif new_value > old_value and not self.following:
            self.follow()

    def action_page_up(self) -> None:
        """Go up by what is on screen."""
        self.scroll_to(y=self.scroll_y - self.page_rows, animate=False)

    def action_page_down(self) -> None:
        """Go down by what is on screen."""
        self.scroll_to(y=self.scroll_y + self.page_rows, animate=False)

    def action_scroll_home(self) -> None:
        """Go to the oldest row."""
        self.scroll_to(y=0, animate=False)

    def action_scroll_end(self) -> None:
        """Go to the newest row and follow."""
        self.follow()

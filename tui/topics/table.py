"""Every topic in a table: sorted, filtered, and one of them chosen."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar

from textual.binding import Binding, BindingType
from textual.geometry import Region, Size
from textual.message import Message

from text.i18n import _
from tui.topics.table_order import TopicsOrder
from tui.topics.table_rows import HEADER, MARK, TopicsRows

if TYPE_CHECKING:
    from collections.abc import Sequence

    from textual.events import Click

    from graph.data import TopicRow

FAR = 1_000_000


class TopicsTable(TopicsRows):
    """Shows `TopicRow`s; one of them is chosen, and stays so while rows come, go and are sorted."""

    class TopicChosen(Message):
        """Another topic is the chosen one; None when there is none."""

        def __init__(self, topic: str | None) -> None:
            super().__init__()
            self.topic = topic

    class TopicOpened(Message):
        """Enter was pressed on the chosen topic."""

    class Arranged(Message):
        """Another order, filter or set of topics is shown."""

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
        self._words = ("", "")

    def show(self, rows: Sequence[TopicRow]) -> None:
        """Show these topics."""
        self._rows = rows
        self._arrange()

    def show_words(self, headline: str, detail: str = "") -> None:
        """Say why there is no row at all, for as long as there is none."""
        if (headline, detail) != self._words:
            self._words = (headline, detail)
            if not self._shown:
                self.refresh()

    @property
    def order(self) -> TopicsOrder:
        """What is sorted by and what is left out."""
        return self._order

    def reorder(self, order: TopicsOrder) -> None:
        """Sort and filter in another way."""
        if order != self._order:
            self._order = order
            self._arrange()
            self.refresh(Region(0, 0, self.size.width, HEADER))
            self.post_message(self.Arranged())

    def filter(self, words: str) -> None:
        """Show only topics whose name or type has each of these words in it."""
        self.reorder(replace(self._order, words=words))

    def sort_by_next(self) -> None:
        """Sort by the next column of those that are shown."""
        self.reorder(self._order.next_column([place.column.id for place in self._places]))

    @property
    def chosen(self) -> str | None:
        """Name of the chosen topic."""
        return self._chosen

    @property
    def chosen_row(self) -> TopicRow | None:
        """The chosen topic as it is now."""
        return next((row for row in self._shown if row.name == self._chosen), None)

    @property
    def shown(self) -> Sequence[TopicRow]:
        """The topics that are shown, in order."""
        return self._shown

    def choose(self, topic: str) -> None:
        """Choose a topic by its name, if it is shown."""
        index = self._index(topic)
        if index is not None:
            self._choose(index)

    def relabel(self) -> None:
        """Draw again, after the language changed."""
        self.refresh()

    def action_move(self, by: int) -> None:
        """Choose the row so many below."""
        if self._shown:
            at = self._index(self._chosen) or 0
            self._choose(max(0, min(at + by, len(self._shown) - 1)))

    def action_page(self, pages: int) -> None:
        """Choose the row a page away."""
        self.action_move(pages * max(1, self.size.height - HEADER - 1))

    def action_open(self) -> None:
        """Tell that the chosen topic is wanted."""
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
        """Where the chosen topic has gone, take the one that has come in its place."""
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
            # Rows that have just come have no scroll bar yet, without which nothing would scroll.
            self.scroll_to(y=target, animate=False, immediate=True, force=True)

    def _empty_words(self) -> tuple[str, str]:
        if self._rows and self._order.words:
            return _("no topic matches “{words}”").format(words=self._order.words), ""
        return self._words

"""All endpoints of a topic with their QoS, in a scrollable view."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.segment import Segment
from textual.binding import Binding, BindingType
from textual.geometry import Size
from textual.scroll_view import ScrollView
from textual.strip import Strip

from tui.topics.endpoint_lines import endpoint_lines

if TYPE_CHECKING:
    from collections.abc import Sequence

    from graph.data import EndpointInfo, TopicRow
    from tui.widgets.drawing import Line


class TopicEndpoints(ScrollView, can_focus=True):
    """Shows publishers and subscribers of a topic, and before them what is incompatible."""

    ALLOW_SELECT = False
    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "topic-endpoints--bad",
        "topic-endpoints--good",
        "topic-endpoints--muted",
        "topic-endpoints--strong",
    }
    DEFAULT_CSS = """
    TopicEndpoints {
        width: 1fr; height: 1fr; overflow-x: hidden; scrollbar-size-vertical: 1;
        &> .topic-endpoints--bad { color: $text-error; text-style: bold; }
        &> .topic-endpoints--good { color: $text-success; text-style: bold; }
        &> .topic-endpoints--muted { color: $text-muted; }
        &> .topic-endpoints--strong { text-style: bold; }
    }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("k", "scroll_up", show=False),
        Binding("j", "scroll_down", show=False),
    ]

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._row: TopicRow | None = None
        self._shown: tuple[str, Sequence[EndpointInfo], Sequence[EndpointInfo], int] | None = None
        self._lines: list[Line] = []

    def show(self, row: TopicRow | None) -> None:
        """Show the endpoints of this topic; wrapped again only if they have changed."""
        other = row is None or self._row is None or row.name != self._row.name
        self._row = row
        shown = None if row is None else (row.name, row.published_by, row.subscribed_by, row.own_publishers)
        if shown != self._shown:
            self._shown = shown
            self._fold()
        if other:
            self.scroll_to(0, 0, animate=False, immediate=True)

    @property
    def text(self) -> str:
        """The whole text as wrapped now."""
        return "\n".join("".join(ink.text for ink in line).rstrip() for line in self._lines)

    def on_language_changed(self) -> None:
        self._fold()

    def on_resize(self) -> None:
        """Wrap to the new width."""
        self._fold()

    def watch_show_vertical_scrollbar(self) -> None:
        """Wrap with or without the scroll bar."""
        self._fold()

    def on_show(self) -> None:
        """Wrap what was set while the widget was hidden."""
        self._fold()

    def render_line(self, y: int) -> Strip:
        width, base = self.scrollable_size.width, self.rich_style
        index = y + self.scroll_offset.y
        if index >= len(self._lines):
            return Strip.blank(width, base)
        segments = []
        for text, look in self._lines[index]:
            style = self.get_component_rich_style(f"topic-endpoints--{look}") if look else base
            segments.append(Segment(text, style))
        return Strip(segments).adjust_cell_length(width, base)

    def _fold(self) -> None:
        width = self.scrollable_size.width
        if width < 1 or not self.is_mounted:
            return
        self._lines = [] if self._row is None else endpoint_lines(self._row, width)
        self.virtual_size = Size(width, len(self._lines))
        self.refresh()

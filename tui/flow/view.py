"""Chains below each other, the newest first; the cursor moves over their steps."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.segment import Segment
from textual.binding import Binding, BindingType
from textual.geometry import Region, Size
from textual.message import Message
from textual.scroll_view import ScrollView
from textual.strip import Strip

from tui.flow.lines import STYLES, FlowLine
from tui.widgets.one_style import OneStyle

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from textual.events import Click

Key = tuple[float, int]


class FlowView(OneStyle, ScrollView, can_focus=True):
    """Shows lines that `lay` makes for a given width; those with a key can be chosen."""

    class StepHighlighted(Message):
        """Another line was chosen."""

    class StepOpened(Message):
        """Enter was pressed on a line, or it was clicked a second time."""

    ALLOW_SELECT = False
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up", "move(-1)", show=False),
        Binding("down", "move(1)", show=False),
        Binding("pageup", "move(-10)", show=False),
        Binding("pagedown", "move(10)", show=False),
        Binding("home", "edge(0)", show=False),
        Binding("end", "edge(-1)", show=False),
        Binding("enter", "open", show=False),
    ]
    COMPONENT_CLASSES: ClassVar[set[str]] = {f"flow--{name}" for name in (*STYLES, "cursor")}
    DEFAULT_CSS = """
    FlowView {
        width: 1fr; height: 1fr; overflow-x: hidden; scrollbar-size-vertical: 1;
        &> .flow--title { text-style: bold; background: $panel; }
        &> .flow--delay { color: $foreground; }
        &> .flow--content { color: $foreground; }
        &> .flow--dim { color: $text-muted; }
        &> .flow--log { color: $text-muted; }
        &> .flow--mic { color: $text-accent; }
        &> .flow--brain { color: $text-warning; }
        &> .flow--command { color: $text-primary; }
        &> .flow--head { color: $text-secondary; }
        &> .flow--drive { color: $text-success; }
        &> .flow--wheels { color: $text-success; }
        &> .flow--speaker { color: $text-accent; }
        &> .flow--cursor { background: $block-cursor-blurred-background; }
        &:focus > .flow--cursor { background: $block-cursor-background 60%; }
    }
    """

    def __init__(self, lay: Callable[[int], list[FlowLine]], *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._lay = lay
        self._lines: list[FlowLine] = []
        self._chosen: Key | None = None

    @property
    def chosen(self) -> Key | None:
        """The chosen line, None while there is none."""
        return self._chosen

    def keys(self) -> Sequence[Key]:
        """The keys of all lines that can be chosen, from the top."""
        return [line.key for line in self._lines if line.key[1] > -2]

    def show(self) -> None:
        """Repeat the layout; at the top, follow what is new, otherwise stay at the chosen line."""
        at_top = self.scroll_offset.y == 0 and (self._chosen is None or self._chosen == next(iter(self.keys()), None))
        before = self._row_of(self._chosen)
        self._lines = self._lay(max(1, self.scrollable_content_region.width))
        self.virtual_size = Size(0, len(self._lines))
        keys = self.keys()
        if at_top or self._chosen not in keys:
            self.choose(keys[0] if keys else None)
        else:
            after = self._row_of(self._chosen)
            if before is not None and after is not None and after != before:
                self.scroll_relative(y=after - before, animate=False)
        self.refresh()

    def choose(self, key: Key | None) -> None:
        """Move the cursor to this line."""
        if key != self._chosen:
            self._chosen = key
            self.post_message(self.StepHighlighted())
            self.refresh()
        row = self._row_of(key)
        if row is not None:
            self.scroll_to_region(Region(0, row, 1, 1), animate=False, force=True)

    def action_move(self, rows: int) -> None:
        """Move the cursor by this many lines."""
        keys = list(self.keys())
        if keys:
            at = keys.index(self._chosen) if self._chosen in keys else 0
            self.choose(keys[max(0, min(len(keys) - 1, at + rows))])

    def action_edge(self, at: int) -> None:
        """Move the cursor to the first or the last line."""
        keys = self.keys()
        if keys:
            self.choose(keys[at])

    def action_open(self) -> None:
        """Fold or unfold the chain of the chosen line."""
        self.post_message(self.StepOpened())

    def on_click(self, event: Click) -> None:
        """Choose the line; a second click opens it."""
        row = event.y + self.scroll_offset.y
        if row < len(self._lines) and self._lines[row].key[1] > -2:
            self.choose(self._lines[row].key)
            if event.chain > 1 or self._lines[row].key[1] == -1:
                self.post_message(self.StepOpened())

    def on_resize(self) -> None:
        """Lay out for the new width."""
        self.show()

    def watch_show_vertical_scrollbar(self) -> None:
        """Lay out for the width that the scroll bar leaves."""
        if self._lines:
            self.show()

    def render_line(self, y: int) -> Strip:
        row, width, base = y + self.scroll_offset.y, self.size.width, self.rich_style
        if row >= len(self._lines):
            return Strip.blank(width, base)
        line = self._lines[row]
        over = self.get_component_rich_style("flow--cursor", partial=True) if line.key == self._chosen else None
        segments = []
        for text, name in line.pieces:
            style = base + self.get_component_rich_style(f"flow--{name}", partial=True)
            segments.append(Segment(text, style if over is None else style + over))
        filler = segments[-1].style if segments and line.key[1] > -2 else base
        return Strip(segments).adjust_cell_length(width, filler)

    def _row_of(self, key: Key | None) -> int | None:
        return next((row for row, line in enumerate(self._lines) if line.key == key), None)

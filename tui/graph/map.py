"""The graph as a map of one node at a time: arrow keys move from it to its neighbours."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.segment import Segment
from textual.binding import Binding, BindingType
from textual.geometry import Region, Size
from textual.message import Message
from textual.scroll_view import ScrollView
from textual.strip import Strip

from text.i18n import _
from tui.graph.map_drawing import CENTRE, MapDrawing, drawing
from tui.graph.neighbours import Neighbours, neighbours, node_called
from tui.graph.places import GraphKind, GraphPlace
from tui.widgets.words import word_strips

if TYPE_CHECKING:
    from textual.events import Click

    from graph.data import GraphUpdate
    from tui.graph.map_drawing import MapStop


class GraphMap(ScrollView, can_focus=True):
    """Draws a node in the middle, its inputs on the left and its outputs on the right."""

    class PlaceWanted(Message):
        """Enter was pressed on a place."""

        def __init__(self, place: GraphPlace) -> None:
            super().__init__()
            self.place = place

    ALLOW_SELECT = False
    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "graph-map--line",
        "graph-map--box",
        "graph-map--name",
        "graph-map--node",
        "graph-map--dim",
        "graph-map--cursor",
    }
    DEFAULT_CSS = """
    GraphMap {
        width: 1fr; height: 1fr; overflow-x: hidden; scrollbar-size-vertical: 1; padding: 0 1;
        &> .graph-map--line { color: $text-muted; }
        &> .graph-map--box { color: $accent; }
        &> .graph-map--name { color: $text-primary; }
        &> .graph-map--node { text-style: bold; }
        &> .graph-map--dim { color: $text-muted; text-style: italic; }
        &> .graph-map--cursor {
            color: $block-cursor-foreground; background: $block-cursor-background;
        }
    }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up,k", "step(-1)", show=False),
        Binding("down,j", "step(1)", show=False),
        Binding("left,h", "across(-1)", show=False),
        Binding("right,l", "across(1)", show=False),
        Binding("enter", "open", show=False),
    ]

    def __init__(self) -> None:
        super().__init__()
        self._middle = ""
        self._around = Neighbours()
        self._drawing = MapDrawing(0)
        self._column, self._at = CENTRE, 0
        self._words = ("", "")

    @property
    def here(self) -> GraphPlace | None:
        stop = self._stop()
        return None if stop is None else stop.place

    def show_node(self, update: GraphUpdate | None, name: str, *, everything: bool) -> None:
        """Draw this node in its current state; for a new one the cursor starts in the middle."""
        node = node_called(update, name)
        if name != self._middle:
            self._column, self._at = CENTRE, 0
            self.scroll_to(y=0, animate=False, immediate=True)
        if update is None or node is None:
            around = self._around if name == self._middle else Neighbours()
            words = _("no node to draw"), _("Choose one in the list of nodes.")
            if name:
                words = _("this node has left the graph"), ""
        else:
            around, words = neighbours(update, node, everything=everything), ("", "")
        if (name, around, words) != (self._middle, self._around, self._words):
            self._middle, self._around, self._words = name, around, words
            self._draw()

    def on_resize(self) -> None:
        """Redraw for the new size."""
        self._draw()

    def action_step(self, by: int) -> None:
        """Move the cursor up or down on this side."""
        self._go(self._column, self._at + by)

    def action_across(self, by: int) -> None:
        """Move the cursor sideways: to the node, or from it to its neighbours."""
        column = self._column + by
        if not 0 <= column <= len(self._drawing.stops) - 1 or not self._drawing.stops[column]:
            return
        here = self._stop()
        row = 0 if here is None else here.row
        stops = self._drawing.stops[column]
        self._go(column, min(range(len(stops)), key=lambda at: abs(stops[at].row - row)))

    def action_open(self) -> None:
        """Request the place at the cursor."""
        here = self.here
        if here is not None:
            self.post_message(self.PlaceWanted(here))

    def on_click(self, event: Click) -> None:
        """Move the cursor to what was clicked; a second click opens it."""
        x = event.x - self.gutter.left
        y = event.y - self.gutter.top + self.scroll_offset.y
        for column, stops in enumerate(self._drawing.stops):
            for at, stop in enumerate(stops):
                piece = self._drawing.pieces[stop.piece]
                if piece.row == y and piece.x <= x < piece.x + len(piece.text):
                    self._go(column, at)
                    if event.chain > 1:
                        self.action_open()
                    return

    def watch_scroll_y(self, old_value: float, new_value: float) -> None:
        """Keep the node in the middle of the visible part."""
        super().watch_scroll_y(old_value, new_value)
        if round(old_value) != round(new_value):
            self._draw()

    def render_line(self, y: int) -> Strip:
        width, base = self.scrollable_content_region.width, self.rich_style
        if self._words[0]:
            strips = word_strips(self._words, width, base, self.app.console)
            return strips[y] if y < len(strips) else Strip.blank(width, base)
        row, x = y + self.scroll_offset.y, 0
        stop = self._stop()
        chosen = -1 if stop is None else stop.piece
        segments: list[Segment] = []
        found = [one for one in enumerate(self._drawing.pieces) if one[1].row == row]
        for number, piece in sorted(found, key=lambda one: one[1].x):
            look = "cursor" if number == chosen and self.has_focus else piece.look or "line"
            style = base + self.get_component_rich_style(f"graph-map--{look}", partial=True)
            segments += [Segment(" " * (piece.x - x), base), Segment(piece.text, style)]
            x = max(x, piece.x) + Segment(piece.text).cell_length
        return Strip(segments).adjust_cell_length(width, base)

    def _stop(self) -> MapStop | None:
        stops = self._drawing.stops[self._column]
        return stops[min(self._at, len(stops) - 1)] if stops else None

    def _go(self, column: int, at: int) -> None:
        stops = self._drawing.stops[column]
        if stops:
            self._column, self._at = column, max(0, min(at, len(stops) - 1))
            row = stops[self._at].row
            self.scroll_to_region(Region(0, row, 1, 1), animate=False, immediate=True)
            self.refresh()

    def _draw(self) -> None:
        region = self.scrollable_content_region
        if not region.width or not region.height:
            return
        top = self.scroll_offset.y
        self._drawing = drawing(self._middle, self._around, region.width, region.height, top)
        if not self._drawing.stops[self._column]:
            self._column, self._at = CENTRE, 0
        height = 0 if self._words[0] else self._drawing.height
        if self.virtual_size.height != height:
            self.virtual_size = Size(0, height)
        self.refresh()


def middle_of(update: GraphUpdate | None, here: GraphPlace | None) -> str:
    """Return the node to draw for a chosen place: the node itself, or one connected to it."""
    if update is None or here is None:
        return update.nodes[0].name if update and update.nodes else ""
    if here.kind is GraphKind.NODE:
        return here.name
    for row in update.services if here.kind is GraphKind.SERVICE else ():
        if row.name == here.name and row.nodes:
            return row.nodes[0]
    for action in update.actions if here.kind is GraphKind.ACTION else ():
        if action.name == here.name and action.servers:
            return action.servers[0]
    return update.nodes[0].name if update.nodes else ""

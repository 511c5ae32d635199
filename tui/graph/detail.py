"""The detail beside the list: a pane for each kind of thing, or words if nothing is chosen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.widgets import ContentSwitcher

from tui.graph.action import ActionPane
from tui.graph.finding import FindingPane
from tui.graph.node import NodePane
from tui.graph.pane import EmptyNotice
from tui.graph.places import GraphKind
from tui.graph.service import ServicePane
from tui.graph.type import TypePane

if TYPE_CHECKING:
    from tui.graph.pane import GraphPane
    from tui.graph.places import GraphPlace

PANES: dict[GraphKind, type[GraphPane]] = {
    GraphKind.NODE: NodePane,
    GraphKind.SERVICE: ServicePane,
    GraphKind.ACTION: ActionPane,
    GraphKind.TYPE: TypePane,
    GraphKind.FINDING: FindingPane,
}
WORDS = "graph-words"


class GraphDetail(ContentSwitcher):
    """Shows one place at a time; its panes keep what was entered in them."""

    def __init__(self) -> None:
        self._panes = {kind: pane(id=f"graph-{kind.value}") for kind, pane in PANES.items()}
        super().__init__(EmptyNotice(id=WORDS), *self._panes.values(), id="graph-detail", initial=WORDS)

    def pane_of(self, place: GraphPlace | None) -> GraphPane | None:
        """Return the pane for places of this kind, None if it does not exist yet."""
        pane = None if place is None else self._panes.get(place.kind)
        return pane if pane is not None and pane.is_mounted else None

    def show_words(self, headline: str, way_out: str) -> None:
        """Say why nothing is shown."""
        self._bring(WORDS)
        self.query_one(f"#{WORDS}", EmptyNotice).show(headline, way_out)

    def show_place(self, pane: GraphPane, name: str, *, everything: bool) -> None:
        """Show the thing with this full name in its pane, with ROS's own things if `everything`."""
        self._bring(pane.id)
        pane.everything = everything
        pane.show_name(name)

    def relabel(self) -> None:
        """Redraw in the current language."""
        for pane in self._panes.values():
            pane.relabel()

    def _bring(self, shown: str | None) -> None:
        if self.current != shown:
            self.current = shown
            self.screen.refresh_bindings()

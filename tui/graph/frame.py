"""What the screen of the graph is made of, and how it is drawn."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from textual.containers import Horizontal
from textual.widgets import ContentSwitcher, Input, Static, TextArea

from text.i18n import _
from tui.frame.screen import DeckScreen
from tui.graph.action import ActionPane
from tui.graph.actions import Housekeeping
from tui.graph.ask import AskPane
from tui.graph.index import Entry, chosen_of, entries
from tui.graph.list import GraphList
from tui.graph.map import GraphMap, middle_of
from tui.graph.node import NodePane
from tui.graph.pane import GraphPane, Words
from tui.graph.parameters import PARAMETER_EVENTS
from tui.graph.place import LISTED, Kind
from tui.graph.service import ServicePane
from tui.graph.tabs import GraphTabs
from tui.graph.trail import Trail
from tui.graph.type import TypePane
from tui.graph.words import why_empty
from tui.widgets.field import Field

if TYPE_CHECKING:
    from textual.app import ComposeResult

    from graph.data import GraphUpdate


DETAILS: dict[Kind, type[GraphPane]] = {
    Kind.NODE: NodePane,
    Kind.SERVICE: ServicePane,
    Kind.ACTION: ActionPane,
    Kind.TYPE: TypePane,
}


class GraphFrame(DeckScreen):
    """Kinds and filter above a list and the detail of the chosen one, or above the drawing."""

    DEFAULT_CSS = """
    GraphFrame {
        #graph-bar { height: 1; }
        #graph-filter { width: 1fr; margin-left: 1; }
        #graph-count { width: auto; padding: 0 1; color: $text-muted; }
        #graph-body { height: 1fr; }
        #graph-detail { width: 1fr; height: 1fr; border-left: solid $panel; }
        GraphList { width: 26; height: 1fr; }
        GraphMap { display: none; }
    }
    GraphFrame.-map {
        #graph-body { display: none; }
        GraphMap { display: block; }
    }
    GraphFrame.-tall, GraphFrame.-high {
        AskPane GraphLinks { max-height: 8; }
        .ask-right { border-top: solid $panel; }
    }
    GraphFrame.-wide {
        .ask-body { layout: horizontal; }
        .ask-right { border-top: none; border-left: solid $panel; }
    }
    GraphFrame.-tiny GraphList { width: 14; }
    GraphFrame.-home GraphList { width: 40; }
    GraphFrame.-wide GraphList { width: 60; }
    """

    def __init__(self) -> None:
        super().__init__()
        self.trail = Trail()
        self.everything = False
        """Whether ROS's own things are listed."""
        self.listed: dict[Kind, list[Entry]] = {}
        """All there is of each kind."""
        self._panes: dict[Kind, GraphPane] = {}
        self._goals_of: set[str] = set()
        """Whose goals were asked for."""
        self._installed: tuple[str, ...] = ()
        """Every type there is on this computer, once somebody has asked for all."""

    def compose_body(self) -> ComposeResult:
        """Kinds and filter above list and detail."""
        with Horizontal(id="graph-bar"):
            yield GraphTabs()
            yield Field(id="graph-filter", compact=True, select_on_focus=False)
            yield Static(id="graph-count", markup=False)
        with Horizontal(id="graph-body"):
            yield GraphList()
            with ContentSwitcher(id="graph-detail", initial="graph-words"):
                yield Words(id="graph-words")
                for kind, pane in DETAILS.items():
                    self._panes[kind] = pane(id=f"graph-{kind.value}")
                yield from self._panes.values()
        yield GraphMap()

    @property
    def names(self) -> GraphList:
        """The names of one kind."""
        return self.query_one(GraphList)

    @property
    def is_typing(self) -> bool:
        """Whether letters go into a text."""
        return isinstance(self.focused, (Input, TextArea))

    @property
    def filter(self) -> Input:
        """Where the words of the filter are typed."""
        return self.query_one("#graph-filter", Input)

    @property
    def map(self) -> GraphMap:
        """The drawing."""
        return self.query_one(GraphMap)

    @property
    def draws(self) -> bool:
        """Whether the drawing is in front."""
        return self.has_class("-map")

    @property
    def pane(self) -> GraphPane | None:
        """The detail in front."""
        here = self.trail.here
        pane = None if here is None else self._panes.get(here.kind)
        return pane if pane is not None and pane.is_mounted else None

    @property
    def shows_pane(self) -> bool:
        """Whether the detail is seen: neither the map nor an empty list is in its place."""
        return self.pane is not None and self.pane.display and not self.draws

    @property
    def node_pane(self) -> NodePane | None:
        """The detail in front, if it is a node's."""
        pane = self.pane
        return pane if isinstance(pane, NodePane) else None

    @property
    def is_settling(self) -> bool:
        """Whether what belongs to the chosen place is still to be loaded."""
        return self.pane is not None and self.pane.is_settling

    @property
    def shows_parameters(self) -> bool:
        """Whether parameters are in front."""
        pane = self.node_pane
        return pane is not None and pane.shows_parameters and self.shows_pane

    @property
    def is_in_list(self) -> bool:
        """Whether keys go to the list of names."""
        return self.focused is self.names

    @property
    def ask_pane(self) -> AskPane | None:
        """The detail in front, if something can be asked there."""
        pane = self.pane
        return pane if isinstance(pane, AskPane) else None

    def watch_goals(self) -> set[str]:
        """Return the action that is shown."""
        here = self.trail.here
        return {here.name} if here is not None and here.kind is Kind.ACTION else set()

    def follow_topics(self) -> set[str]:
        """Return where nodes tell that a parameter has changed, shown now or in a moment."""
        return {PARAMETER_EVENTS}

    def take(self, update: GraphUpdate | None) -> None:
        """Show this graph from now on."""
        self.listed = {kind: entries(update, kind, self._installed) for kind in LISTED}
        self.redraw()

    async def find_installed(self) -> None:
        """List the types that are installed, though nobody uses them."""
        from graph.messages.browse import interfaces

        self._installed = await asyncio.to_thread(interfaces)
        self.take(self.feed.update)

    def redraw(self) -> None:
        """Show list and detail as things stand."""
        if not self.is_mounted:
            return
        kind, words = self.trail.kind, self.filter.value
        self.filter.placeholder = _("filter: words of a name or a type")
        fitting = {
            each: chosen_of(listed, "", everything=self.everything)
            for each, listed in self.listed.items()
        }
        self.query_one(GraphTabs).show(kind, {each: len(found) for each, found in fitting.items()})
        shown = chosen_of(fitting.get(kind, []), words, everything=True)
        self._count(len(shown), len(self.listed.get(kind, [])))
        self.names.show_entries(kind, shown, self.trail.chosen.get(kind, ""), words)
        if self.names.chosen_name and not self.trail.chosen.get(kind):
            self.trail.choose(self.names.chosen_name)
        self._show_detail(shown)
        if self.watch_goals() != self._goals_of:
            self._goals_of = self.watch_goals()
            self.topics_changed()
        if self.draws:
            update = self.feed.update
            middle = middle_of(update, self.trail.here)
            self.map.show_node(update, middle, everything=self.everything)

    def _show_detail(self, shown: list[Entry]) -> None:
        switcher = self.query_one("#graph-detail", ContentSwitcher)
        pane, here = self.pane, self.trail.here
        if pane is None or here is None or not self.names.chosen_name:
            if switcher.current != "graph-words":
                switcher.current = "graph-words"
                self.refresh_bindings()
            key = self.deck.keys_of(Housekeeping)[0]
            words = why_empty(
                self.feed, self.trail.kind, self.listed.get(self.trail.kind, []), all_key=key
            )
            self.query_one("#graph-words", Words).show(*(words if not shown else ("", "")))
            return
        if switcher.current != pane.id:
            switcher.current = pane.id
            self.refresh_bindings()
        pane.everything = self.everything
        pane.show_name(here.name)

    def _count(self, shown: int, everything: int) -> None:
        words = _("{shown} of {n}").format(shown=shown, n=everything)
        count = self.query_one("#graph-count", Static)
        if words != count.content:
            count.update(words)

"""Nodes, services, actions and types: who talks to whom, and what can be asked of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.containers import Horizontal
from textual.widgets import ContentSwitcher, Input, Static, TextArea

from graph.housekeeping import is_housekeeping
from tui.actions import bindings
from tui.actions.graph import GRAPH_ACTIONS, Housekeeping
from tui.i18n import N_, _
from tui.screens import graph_parameters
from tui.screens.base import DeckScreen
from tui.screens.graph_trail import Trail
from tui.widgets.graph_index import Entry, chosen_of, entries
from tui.widgets.graph_list import GraphList
from tui.widgets.graph_node import NodePane
from tui.widgets.graph_pane import GraphPane, Words
from tui.widgets.graph_place import LISTED, Kind, Place
from tui.widgets.graph_tabs import GraphTabs
from tui.widgets.graph_words import why_empty
from tui.widgets.rows import Rows

if TYPE_CHECKING:
    from textual.app import ComposeResult

    from graph.data import GraphUpdate
    from tui.messages import GraphChanged, LanguageChanged, SessionChanged, StatusChanged


class GraphScreen(DeckScreen):
    """A list by kind, and the detail of the chosen one."""

    tab: ClassVar[str] = "graph"
    about: ClassVar[str] = N_(
        "Nodes with what they publish, hear, serve and call; services to be called, actions to "
        "be sent goals, types down to their fields."
    )
    BINDINGS: ClassVar = bindings(*GRAPH_ACTIONS)
    DEFAULT_CSS = """
    GraphScreen {
        #graph-bar { height: 1; }
        #graph-filter { width: 1fr; margin-left: 1; }
        #graph-count { width: auto; padding: 0 1; color: $text-muted; }
        #graph-body { height: 1fr; }
        #graph-detail { width: 1fr; height: 1fr; border-left: solid $panel; }
        GraphList { width: 26; height: 1fr; }
    }
    GraphScreen.-tiny GraphList { width: 14; }
    GraphScreen.-home GraphList { width: 40; }
    GraphScreen.-wide GraphList { width: 60; }
    """

    def __init__(self) -> None:
        super().__init__()
        self.trail = Trail()
        self.everything = False
        """Whether ROS's own things are listed."""
        self._listed: dict[Kind, list[Entry]] = {}

    def compose_body(self) -> ComposeResult:
        """Kinds and filter above list and detail."""
        with Horizontal(id="graph-bar"):
            yield GraphTabs()
            yield Input(id="graph-filter", compact=True, select_on_focus=False)
            yield Static(id="graph-count", markup=False)
        with Horizontal(id="graph-body"):
            yield GraphList()
            with ContentSwitcher(id="graph-detail", initial="graph-words"):
                yield Words(id="graph-words")
                yield NodePane(id=f"graph-{Kind.NODE.value}")

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
    def pane(self) -> GraphPane | None:
        """The detail in front."""
        here = self.trail.here
        if here is None or not self.is_mounted:
            return None
        found = self.query(f"#graph-{here.kind.value}").results(GraphPane)
        return next(iter(found), None)

    @property
    def node_pane(self) -> NodePane | None:
        """The detail in front, if it is a node's."""
        pane = self.pane
        return pane if isinstance(pane, NodePane) else None

    def on_mount(self) -> None:
        """Begin in the list."""
        self.names.focus()
        self.redraw()

    def on_graph_changed(self, message: GraphChanged) -> None:
        """Show who is there now."""
        self._take(message.update)

    def on_status_changed(self, message: StatusChanged) -> None:
        """Show what processes have become."""
        super().on_status_changed(message)
        if self.pane is not None:
            self.pane.redraw()

    def on_session_changed(self, message: SessionChanged) -> None:
        """Forget the graph of a session that has ended."""
        super().on_session_changed(message)
        self.trail.forget()
        self._take(None)

    def on_language_changed(self, message: LanguageChanged) -> None:
        """Say everything anew."""
        super().on_language_changed(message)
        for pane in self.query(GraphPane):
            pane.relabel()
        self.redraw()

    def _take(self, update: GraphUpdate | None) -> None:
        self._listed = {kind: entries(update, kind) for kind in LISTED}
        self.redraw()

    def redraw(self) -> None:
        """Show list and detail as things stand."""
        if not self.is_mounted:
            return
        kind, words = self.trail.kind, self.filter.value
        self.filter.placeholder = _("filter: words of a name or a type")
        fitting = {
            each: chosen_of(listed, "", everything=self.everything)
            for each, listed in self._listed.items()
        }
        self.query_one(GraphTabs).show(kind, {each: len(found) for each, found in fitting.items()})
        shown = chosen_of(fitting.get(kind, []), words, everything=True)
        self._count(len(shown), len(self._listed.get(kind, [])))
        self.names.show_entries(kind, shown, self.trail.chosen.get(kind, ""), words)
        if self.names.chosen_name and not self.trail.chosen.get(kind):
            self.trail.choose(self.names.chosen_name)
        self._show_detail(shown)

    def _show_detail(self, shown: list[Entry]) -> None:
        switcher = self.query_one("#graph-detail", ContentSwitcher)
        pane, here = self.pane, self.trail.here
        if pane is None or here is None or not self.names.chosen_name:
            switcher.current = "graph-words"
            key = self.deck.keys_of(Housekeeping)[0]
            words = why_empty(
                self.feed.update, self.trail.kind, self._listed.get(self.trail.kind, []),
                running=self.feed.link is not None, all_key=key,
            )  # fmt: skip
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

    @on(Rows.Highlighted, "GraphList")
    def _highlighted(self) -> None:
        name = self.names.chosen_name
        if name and name != self.trail.chosen.get(self.trail.kind):
            self.trail.choose(name)
            self.redraw()
            self.refresh_bindings()

    @on(Rows.Opened, "GraphList")
    def _opened(self) -> None:
        first = None if self.pane is None else self.pane.first()
        if first is not None:
            first.focus()

    @on(Rows.Opened, ".graph-links")
    async def _followed(self, message: Rows.Opened) -> None:
        place = Place.of_key(message.key)
        if place is not None:
            await self.go(place)

    @on(Rows.Opened, "#graph-parameters")
    def _edited(self) -> None:
        if self.node_pane is not None:
            graph_parameters.edit(self.deck, self.node_pane.parameters)

    @on(GraphTabs.Selected)
    def _selected(self, message: GraphTabs.Selected) -> None:
        self.list_kind(message.kind)

    @on(Input.Changed, "#graph-filter")
    def _filter_changed(self) -> None:
        self.redraw()

    @on(Input.Submitted, "#graph-filter")
    def _filter_done(self) -> None:
        self.names.focus()

    async def go(self, place: Place) -> None:
        """Go where a link leads: here, or to the screen of topics."""
        if place.kind is Kind.TOPIC:
            await self._go_to_topic(place.name)
            return
        self.trail.go(place)
        self._arrive()

    async def _go_to_topic(self, topic: str) -> None:
        from tui.screens.topics import TopicsScreen

        await self.deck.show_screen("topics")
        screen = self.deck.get_screen("topics")
        if isinstance(screen, TopicsScreen):
            screen.filter.value = ""
            screen.table.filter("")
            if is_housekeeping(topic) and not screen.table.order.housekeeping:
                screen.toggle_housekeeping()
            # A screen that has just been made hears of its topics first.
            screen.call_later(screen.table.choose, topic)

    def go_back(self) -> None:
        """Go back to where the newest link was followed, else to the list."""
        if self.filter.has_focus or (self.names.has_focus and self.filter.value):
            self.filter.value = ""
            self.names.focus()
        elif not self.names.has_focus:
            self.names.focus()
        elif self.trail.back():
            self._arrive()

    def _arrive(self) -> None:
        """Show the chosen place, though a filter or the lack of `everything` had hidden it."""
        here = self.trail.here
        if here is not None:
            listed = {entry.name: entry for entry in self._listed.get(here.kind, [])}
            entry = listed.get(here.name)
            if entry is not None and entry.housekeeping:
                self.everything = True
            if entry is None or not chosen_of([entry], self.filter.value, everything=True):
                self.filter.value = ""
        self.redraw()
        self.names.focus()
        self.refresh_bindings()

    def list_kind(self, kind: Kind) -> None:
        """List another kind."""
        self.trail.kind = kind
        self.redraw()
        self.names.focus()
        self.refresh_bindings()

    def list_next(self, by: int) -> None:
        """List the kind that stands so many tabs to the right."""
        at = LISTED.index(self.trail.kind) + by
        self.list_kind(LISTED[at % len(LISTED)])

    def focus_filter(self) -> None:
        """Put the cursor into the filter."""
        self.set_focus(self.filter)

    def toggle_everything(self) -> None:
        """Show or hide what ROS itself needs."""
        self.everything = not self.everything
        self.redraw()

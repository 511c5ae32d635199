"""Nodes, services, actions and types: who talks to whom, and what can be asked of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Protocol, cast

from textual import on
from textual.binding import Binding
from textual.containers import Horizontal
from textual.widgets import Input, Static, TextArea

from text.i18n import N_, _
from tui.actions import bindings
from tui.frame.screen import DeckScreen
from tui.graph import parameter_changes
from tui.graph.action import ActionPane, CancelGoalScreen
from tui.graph.actions import GRAPH_ACTIONS, ShowEverything
from tui.graph.ask import AskPane
from tui.graph.detail import GraphDetail
from tui.graph.index import GraphIndex, why_empty
from tui.graph.list import GraphList
from tui.graph.map import GraphMap, middle_of
from tui.graph.node import NodePane
from tui.graph.parameters import PARAMETER_EVENTS
from tui.graph.places import LISTED, GraphKind, GraphPlace, PlaceHistory
from tui.graph.tabs import GraphTabs
from tui.graph.type import GraphTypeTree
from tui.widgets.field import Field
from tui.widgets.rows import Rows

if TYPE_CHECKING:
    from textual.app import ComposeResult

    from graph.data import GraphUpdate, SeenGoal
    from tui.graph.index import GraphEntry
    from tui.graph.pane import GraphPane
    from tui.session.messages import GraphChanged, LanguageChanged, SessionChanged, StatusChanged


class ShowsTopic(Protocol):
    """What the graph needs of the screen of topics."""

    def show_topic(self, topic: str) -> None:
        """Choose a topic, though a filter or an option had hidden it."""


class GraphScreen(DeckScreen):
    """Kinds and filter above a list and the detail of the chosen one, or above the drawing."""

    tab: ClassVar[str] = "graph"
    about: ClassVar[str] = N_(
        "Nodes with what they publish, hear, serve and call; services to be called, actions to "
        "be sent goals, types down to their fields. Enter on a name goes there. The map draws a "
        "node with those that it talks to: () marks a service, ⚑ an action."
    )
    BINDINGS: ClassVar = [
        *bindings(*GRAPH_ACTIONS),
        # An action on Tab takes away what every screen does with it where the action cannot be.
        Binding("tab", "app.focus_next", show=False),
    ]

    DEFAULT_CSS = """
    GraphScreen {
        #graph-bar { height: 1; }
        #graph-filter { width: 1fr; margin-left: 1; }
        #graph-count { width: auto; padding: 0 1; color: $text-muted; }
        #graph-body { height: 1fr; }
        #graph-detail { width: 1fr; height: 1fr; border-left: solid $panel; }
        GraphList { width: 26; height: 1fr; }
        GraphMap { display: none; }
    }
    GraphScreen.-map {
        #graph-body { display: none; }
        GraphMap { display: block; }
    }
    GraphScreen.-tall, GraphScreen.-high {
        AskPane GraphLinks { max-height: 8; }
        .ask-right { border-top: solid $panel; }
    }
    GraphScreen.-wide {
        .ask-body { layout: horizontal; }
        .ask-right { border-top: none; border-left: solid $panel; }
    }
    GraphScreen.-tiny GraphList { width: 14; }
    GraphScreen.-home GraphList { width: 40; }
    GraphScreen.-wide GraphList { width: 60; }
    """

    def __init__(self) -> None:
        super().__init__()
        self.history = PlaceHistory()
        self.index = GraphIndex()
        self._detail = GraphDetail()
        self._goals_of: set[str] = set()
        """Whose goals were asked for."""

    def compose_body(self) -> ComposeResult:
        """Kinds and filter above list and detail."""
        with Horizontal(id="graph-bar"):
            yield GraphTabs()
            yield Field(id="graph-filter", compact=True, select_on_focus=False)
            yield Static(id="graph-count", markup=False)
        with Horizontal(id="graph-body"):
            yield GraphList()
            yield self._detail
        yield GraphMap()

    # What is in front

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
        return self._detail.pane_of(self.history.here)

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
        here = self.history.here
        return {here.name} if here is not None and here.kind is GraphKind.ACTION else set()

    def follow_topics(self) -> set[str]:
        """Return where nodes tell that a parameter has changed, shown now or in a moment."""
        return {PARAMETER_EVENTS}

    # What is shown

    def take(self, update: GraphUpdate | None) -> None:
        """Show this graph from now on."""
        self.index.take(update)
        self.redraw()

    def redraw(self) -> None:
        """Show list and detail as things stand."""
        if not self.is_mounted:
            return
        kind, words = self.history.kind, self.filter.value
        self.filter.placeholder = _("filter: words of a name or a type")
        counts = {each: len(self.index.fitting(each)) for each in self.index.listed}
        self.query_one(GraphTabs).show(kind, counts)
        shown = self.index.fitting(kind, words)
        self._count(len(shown), len(self.index.all_of(kind)))
        self.names.show_entries(kind, shown, self.history.chosen.get(kind, ""), words)
        if self.names.chosen_name and not self.history.chosen.get(kind):
            self.history.choose(self.names.chosen_name)
        self._show_detail(shown)
        if self.watch_goals() != self._goals_of:
            self._goals_of = self.watch_goals()
            self.topics_changed()
        if self.draws:
            update = self.feed.update
            middle = middle_of(update, self.history.here)
            self.map.show_node(update, middle, everything=self.index.everything)

    def _show_detail(self, shown: list[GraphEntry]) -> None:
        pane, here = self.pane, self.history.here
        if pane is not None and here is not None and self.names.chosen_name:
            self._detail.show_place(pane, here.name, everything=self.index.everything)
            return
        key, kind = self.deck.keys_of(ShowEverything)[0], self.history.kind
        words = why_empty(self.feed, kind, self.index.all_of(kind), all_key=key)
        self._detail.show_words(*(words if not shown else ("", "")))

    def _count(self, shown: int, everything: int) -> None:
        words = _("{shown} of {n}").format(shown=shown, n=everything)
        count = self.query_one("#graph-count", Static)
        if words != count.content:
            count.update(words)

    # What happens

    def on_mount(self) -> None:
        """Begin in the list."""
        self.names.focus()
        self.redraw()

    def on_graph_changed(self, message: GraphChanged) -> None:
        """Show who is there now, and parameters that somebody has changed."""
        self.take(message.update)
        if self.node_pane is not None and self.node_pane.shows_parameters:
            self.node_pane.parameters.hear(message.update.samples.get(PARAMETER_EVENTS, ()))

    def on_status_changed(self, message: StatusChanged) -> None:
        """Show what processes have become."""
        super().on_status_changed(message)
        if self.pane is not None:
            self.pane.redraw()

    def on_session_changed(self, message: SessionChanged) -> None:
        """Forget the graph of a session that has ended."""
        super().on_session_changed(message)
        self.history.forget()
        self.take(None)

    def on_language_changed(self, message: LanguageChanged) -> None:
        """Say everything anew."""
        super().on_language_changed(message)
        self._detail.relabel()
        self.redraw()

    @on(Rows.Highlighted, "GraphList")
    def _highlighted(self) -> None:
        name = self.names.chosen_name
        if name and name != self.history.chosen.get(self.history.kind):
            self.history.choose(name)
            self.redraw()
            self.refresh_bindings()

    @on(Rows.Opened, "GraphList")
    def _opened(self) -> None:
        first = None if self.pane is None else self.pane.first()
        if first is not None:
            first.focus()

    @on(Rows.Opened, ".graph-links")
    async def _followed(self, message: Rows.Opened) -> None:
        place = GraphPlace.of_key(message.key)
        if place is not None:
            await self.go(place)

    @on(Rows.Opened, "#graph-parameters")
    def _edited(self) -> None:
        if self.node_pane is not None:
            parameter_changes.edit(self.app, self.node_pane.parameters)

    @on(GraphTypeTree.TypeWanted)
    async def _type_wanted(self, message: GraphTypeTree.TypeWanted) -> None:
        await self.go(GraphPlace(GraphKind.TYPE, message.type_name))

    @on(GraphMap.PlaceWanted)
    async def _place_wanted(self, message: GraphMap.PlaceWanted) -> None:
        if message.place.kind is not GraphKind.NODE:
            self.remove_class("-map")
        await self.go(message.place)

    @on(ActionPane.CancelWanted)
    def _cancel_wanted(self, message: ActionPane.CancelWanted) -> None:
        self.app.push_screen(CancelGoalScreen(message.goal, message.state), self._cancel)

    def _cancel(self, goal: SeenGoal | None) -> None:
        if goal is not None and self.feed.graph is not None:
            self.feed.graph.cancel_seen_goal(goal.action, goal.goal_id)

    @on(GraphTabs.Selected)
    def _selected(self, message: GraphTabs.Selected) -> None:
        self.list_kind(message.kind)

    @on(Input.Changed, "#graph-filter")
    def _filter_changed(self) -> None:
        self.redraw()

    @on(Input.Submitted, "#graph-filter")
    def _filter_done(self) -> None:
        self.names.focus()

    # What is done

    async def go(self, place: GraphPlace) -> None:
        """Go where a link leads: here, or to the screen of topics."""
        if place.kind is GraphKind.TOPIC:
            await self._go_to_topic(place.name)
            return
        self.history.go(place)
        self._arrive()

    async def _go_to_topic(self, topic: str) -> None:
        await self.deck.show_screen("topics")
        cast("ShowsTopic", self.app.get_screen("topics")).show_topic(topic)

    def go_back(self) -> None:
        """Go back to where the newest link was followed, else to the list."""
        in_list = self.focused is self.names
        if self.focused is self.filter or (in_list and self.filter.value):
            self.filter.value = ""
            self.names.focus()
        elif self.draws:
            if not self.history.back():
                self.toggle_map()
            else:
                self._arrive()
        elif not in_list:
            self.names.focus()
        elif self.history.back():
            self._arrive()

    def _arrive(self) -> None:
        """Show the chosen place, though a filter or the lack of `everything` had hidden it."""
        here = self.history.here
        if here is not None and not self.index.reveal(here, self.filter.value):
            self.filter.value = ""
        self.redraw()
        (self.map if self.draws else self.names).focus()
        self.refresh_bindings()

    def toggle_map(self) -> None:
        """Draw the graph around the chosen node, or list it again."""
        self.toggle_class("-map")
        if self.draws:
            middle = middle_of(self.feed.update, self.history.here)
            if middle:
                self.history.go(GraphPlace(GraphKind.NODE, middle))
        self._arrive()

    def list_kind(self, kind: GraphKind) -> None:
        """List another kind."""
        self.remove_class("-map")
        self.history.kind = kind
        self.redraw()
        self.names.focus()
        self.refresh_bindings()

    def list_next(self, by: int) -> None:
        """List the kind that stands so many tabs to the right; left of a detail is the list."""
        if self.focused not in {self.names, None}:
            if by < 0:
                self.names.focus()
            return
        at = LISTED.index(self.history.kind) + by
        self.list_kind(LISTED[at % len(LISTED)])

    def focus_filter(self) -> None:
        """Put the cursor into the filter."""
        self.set_focus(self.filter)

    def toggle_everything(self) -> None:
        """Show or hide what ROS itself needs."""
        self.index.everything = not self.index.everything
        if self.index.everything:
            # It reads the directories of all packages.
            self.run_worker(self._find_installed(), group="load", exit_on_error=False)
        self.redraw()

    async def _find_installed(self) -> None:
        await self.index.find_installed()
        self.take(self.feed.update)

    def save_parameters(self) -> None:
        """Ask for a file, and write the node's parameters into it."""
        if self.node_pane is not None:
            parameter_changes.save(self.app, self.node_pane.parameters)

    def load_parameters(self) -> None:
        """Ask for a file, and set what it has for the node."""
        if self.node_pane is not None:
            parameter_changes.load(self.app, self.node_pane.parameters)

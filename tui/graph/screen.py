"""Nodes, services, actions and types: who talks to whom, and what can be asked of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.binding import Binding
from textual.widgets import Input

from graph.housekeeping import is_housekeeping
from text.i18n import N_
from tui.actions import bindings
from tui.graph import parameters_dialog as graph_parameters
from tui.graph.action import ActionPane
from tui.graph.actions import GRAPH_ACTIONS
from tui.graph.frame import GraphFrame
from tui.graph.goal import CancelGoalScreen
from tui.graph.index import chosen_of
from tui.graph.map import GraphMap, middle_of
from tui.graph.pane import GraphPane
from tui.graph.parameters import PARAMETER_EVENTS
from tui.graph.place import LISTED, Kind, Place
from tui.graph.tabs import GraphTabs
from tui.graph.type_tree import GraphTypeTree
from tui.widgets.rows import Rows

if TYPE_CHECKING:
    from graph.data import SeenGoal
    from tui.session.messages import GraphChanged, LanguageChanged, SessionChanged, StatusChanged


class GraphScreen(GraphFrame):
    """Follows links, goes back, and asks what is to be asked."""

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
        self.trail.forget()
        self.take(None)

    def on_language_changed(self, message: LanguageChanged) -> None:
        """Say everything anew."""
        super().on_language_changed(message)
        for pane in self.query(GraphPane):
            pane.relabel()
        self.redraw()

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
            graph_parameters.edit(self.app, self.node_pane.parameters)

    @on(GraphTypeTree.Wanted)
    async def _type_wanted(self, message: GraphTypeTree.Wanted) -> None:
        await self.go(Place(Kind.TYPE, message.type_name))

    @on(GraphMap.Wanted)
    async def _place_wanted(self, message: GraphMap.Wanted) -> None:
        if message.place.kind is not Kind.NODE:
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

    async def go(self, place: Place) -> None:
        """Go where a link leads: here, or to the screen of topics."""
        if place.kind is Kind.TOPIC:
            await self._go_to_topic(place.name)
            return
        self.trail.go(place)
        self._arrive()

    async def _go_to_topic(self, topic: str) -> None:
        from tui.topics.screen import TopicsScreen

        await self.deck.show_screen("topics")
        screen = self.app.get_screen("topics")
        if isinstance(screen, TopicsScreen):
            screen.filter.value = ""
            screen.table.filter("")
            if is_housekeeping(topic) and not screen.table.order.housekeeping:
                screen.toggle_housekeeping()
            # A screen that has just been made hears of its topics first.
            screen.call_later(screen.table.choose, topic)

    def go_back(self) -> None:
        """Go back to where the newest link was followed, else to the list."""
        in_list = self.focused is self.names
        if self.focused is self.filter or (in_list and self.filter.value):
            self.filter.value = ""
            self.names.focus()
        elif self.draws:
            if not self.trail.back():
                self.toggle_map()
            else:
                self._arrive()
        elif not in_list:
            self.names.focus()
        elif self.trail.back():
            self._arrive()

    def _arrive(self) -> None:
        """Show the chosen place, though a filter or the lack of `everything` had hidden it."""
        here = self.trail.here
        if here is not None:
            listed = {entry.name: entry for entry in self.listed.get(here.kind, [])}
            entry = listed.get(here.name)
            if entry is not None and entry.housekeeping:
                self.everything = True
            if entry is None or not chosen_of([entry], self.filter.value, everything=True):
                self.filter.value = ""
        self.redraw()
        (self.map if self.draws else self.names).focus()
        self.refresh_bindings()

    def toggle_map(self) -> None:
        """Draw the graph around the chosen node, or list it again."""
        self.toggle_class("-map")
        if self.draws:
            middle = middle_of(self.feed.update, self.trail.here)
            if middle:
                self.trail.go(Place(Kind.NODE, middle))
        self._arrive()

    def list_kind(self, kind: Kind) -> None:
        """List another kind."""
        self.remove_class("-map")
        self.trail.kind = kind
        self.redraw()
        self.names.focus()
        self.refresh_bindings()

    def list_next(self, by: int) -> None:
        """List the kind that stands so many tabs to the right; left of a detail is the list."""
        if self.focused not in {self.names, None}:
            if by < 0:
                self.names.focus()
            return
        at = LISTED.index(self.trail.kind) + by
        self.list_kind(LISTED[at % len(LISTED)])

    def focus_filter(self) -> None:
        """Put the cursor into the filter."""
        self.set_focus(self.filter)

    def toggle_everything(self) -> None:
        """Show or hide what ROS itself needs."""
        self.everything = not self.everything
        if self.everything:
            # It reads the directories of all packages.
            self.run_worker(self.find_installed(), group="load", exit_on_error=False)
        self.redraw()

    def save_parameters(self) -> None:
        """Ask for a file, and write the node's parameters into it."""
        if self.node_pane is not None:
            graph_parameters.save(self.app, self.node_pane.parameters)

    def load_parameters(self) -> None:
        """Ask for a file, and set what it has for the node."""
        if self.node_pane is not None:
            graph_parameters.load(self.app, self.node_pane.parameters)

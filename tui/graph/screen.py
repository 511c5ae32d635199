"""Nodes, services, actions and types: who talks to whom, with calls, goals and parameters."""

from __future__ import annotations

from typing import Any, ClassVar, cast

from textual import getters, on, work
from textual.app import ComposeResult
from textual.binding import Binding
from textual.containers import Horizontal
from textual.widgets import ContentSwitcher, Input, Static, TextArea

from graph.data import GraphUpdate
from text.i18n import N_, _
from tui.actions import bindings
from tui.frame.screen import DeckScreen
from tui.graph.action import ActionPane
from tui.graph.actions import GRAPH_ACTIONS, show_everything
from tui.graph.ask import AskPane
from tui.graph.finding import FindingPane, goal_of
from tui.graph.index import LISTED, LOOKS, TITLES, GraphIndex, GraphKind, GraphPlace, PlaceHistory, failures_of
from tui.graph.node import NodePane
from tui.graph.pane import EmptyNotice, GraphList, GraphPane, why_empty
from tui.graph.parameters import PARAMETER_EVENTS
from tui.graph.service import ServicePane
from tui.graph.type import TypePane
from tui.session.messages import GraphChanged, LanguageChanged, SessionChanged, StatusChanged
from tui.widgets.field import Field
from tui.widgets.rows import Rows
from tui.widgets.tab_line import TabEntry, TabLine

SETTLE_S = 1.0
"""How often findings are looked at, whether or not anything arrives."""


WORDS = "graph-words"


class GraphScreen(DeckScreen):
    """Kinds and filter above a list and the detail of the chosen entry."""

    tab: ClassVar[str] = "graph"
    AUTO_FOCUS: ClassVar[str] = "GraphList"
    parts: ClassVar[tuple[str, ...]] = ("#graph-detail",)
    about: ClassVar[str] = N_(
        "Nodes with what they publish, hear, serve and call; services to be called, actions to "
        "be sent goals, types down to their fields; findings are what is wrong, with what to do "
        "about it. Enter on a name goes there."
    )
    BINDINGS: ClassVar = [
        *bindings(*GRAPH_ACTIONS),
        # Where an action on Tab is disabled, it would also block the usual effect of that key.
        Binding("tab", "app.focus_next", show=False),
    ]

    DEFAULT_CSS = """
    GraphScreen {
        #graph-bar { height: 1; }
        #graph-filter { width: 1fr; margin-left: 1; }
        #graph-count { width: auto; padding: 0 1; color: $text-muted; }
        #graph-body { height: 1fr; }
        #graph-detail { width: 1fr; height: 1fr; border-left: solid $panel; }
        #graph-detail.-maximized { border-left: none; }
        GraphList { width: 26; height: 1fr; }
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
        self._panes: dict[GraphKind, GraphPane] = {
            GraphKind.NODE: NodePane(id="graph-node"),
            GraphKind.SERVICE: ServicePane(id="graph-service"),
            GraphKind.ACTION: ActionPane(id="graph-action"),
            GraphKind.TYPE: TypePane(id="graph-type"),
            GraphKind.FINDING: FindingPane(self.index, id="graph-finding"),
        }
        """They keep what was entered in them."""
        self._detail = ContentSwitcher(EmptyNotice(id=WORDS), *self._panes.values(), id="graph-detail", initial=WORDS)
        self._goals_of: set[str] = set()  # Actions whose goals were requested.
        self._failures: dict[str, str] = {}

    def compose_body(self) -> ComposeResult:
        with Horizontal(id="graph-bar"):
            yield TabLine()
            yield Field(id="graph-filter", compact=True, select_on_focus=False)
            yield Static(id="graph-count", markup=False)
        with Horizontal(id="graph-body"):
            yield GraphList()
            yield self._detail

    # State

    names: getters.query_one[GraphList] = getters.query_one(GraphList)

    @property
    def is_typing(self) -> bool:
        return isinstance(self.focused, (Input, TextArea))

    filter = getters.query_one("#graph-filter", Input)

    @property
    def pane(self) -> GraphPane | None:
        here = self.history.here
        pane = None if here is None else self._panes.get(here.kind)
        return pane if pane is not None and pane.is_mounted else None

    @property
    def shows_pane(self) -> bool:
        return self.pane is not None and self.pane.display

    @property
    def node_pane(self) -> NodePane | None:
        return pane if isinstance(pane := self.pane, NodePane) else None

    @property
    def ask_pane(self) -> AskPane | None:
        return pane if isinstance(pane := self.pane, AskPane) else None

    @property
    def is_settling(self) -> bool:
        return self.pane is not None and self.pane.is_settling

    @property
    def shows_parameters(self) -> bool:
        pane = self.node_pane
        return pane is not None and pane.shows_parameters and self.shows_pane

    def watch_goals(self) -> set[str]:
        here = self.history.here
        return {here.name} if here is not None and here.kind is GraphKind.ACTION else set()

    def follow_topics(self) -> set[str]:
        """Return the topic that reports changes of parameters, even before they are shown."""
        return {PARAMETER_EVENTS}

    # Display

    def take(self, update: GraphUpdate | None) -> None:
        self._failures = failures_of(self.feed.nodes.values())
        self.index.take(update, self._failures)
        self.redraw()

    def redraw(self) -> None:
        if not self.is_mounted:
            return
        kind, words = self.history.kind, self.filter.value
        self.filter.placeholder = _("filter: words of a name or a type")
        worst = LOOKS[self.index.findings[0].level][2] if self.index.findings else ""
        tabs = [
            TabEntry(
                each.value, f"{_(title)} {len(self.index.fitting(each))}", worst if each is GraphKind.FINDING else ""
            )
            for each, title in TITLES.items()
        ]
        self.query_one(TabLine).show_tabs(kind.value, tabs)
        shown, listed = self.index.fitting(kind, words), self.index.listed[kind]
        told, count = (
            _("{shown} of {n}").format(shown=len(shown), n=len(listed)),
            self.query_one("#graph-count", Static),
        )
        if told != count.content:
            count.update(told)
        self.names.show_entries(kind, shown, self.history.chosen.get(kind, ""), words)
        if self.names.chosen_name and not self.history.chosen.get(kind):
            self.history.choose(self.names.chosen_name)
        pane, here = self.pane, self.history.here
        if pane is not None and here is not None and self.names.chosen_name:
            self._bring(pane.id)
            pane.everything = self.index.everything
            pane.show_name(here.name)
        else:
            self._bring(WORDS)
            why = why_empty(self.feed, kind, listed, all_key=self.deck.keys_of(show_everything)[0])
            self.query_one(f"#{WORDS}", EmptyNotice).show(*(why if not shown else ("", "")))
        # What only messages show is found while somebody looks at findings: it costs more.
        wants = (self.watch_goals(), kind is GraphKind.FINDING)
        if wants != (self._goals_of, self.measure_all):
            self._goals_of, self.measure_all = wants
            self.topics_changed()

    def _bring(self, shown: str | None) -> None:
        if self._detail.current != shown:
            self._detail.current = shown
            self.refresh_bindings()

    # Message handlers

    def on_mount(self) -> None:
        self.names.focus()
        self.set_interval(SETTLE_S, self._settle)
        self.redraw()

    def on_graph_changed(self, message: GraphChanged) -> None:
        self.take(message.update)
        if self.node_pane is not None and self.node_pane.shows_parameters:
            self.node_pane.parameters.hear(message.update.samples.get(PARAMETER_EVENTS, ()))

    def on_status_changed(self, message: StatusChanged) -> None:
        del message
        if self._failures != failures_of(self.feed.nodes.values()):
            self.take(self.feed.update)
        if self.pane is not None:
            self.pane.redraw()

    def on_session_changed(self, message: SessionChanged) -> None:
        del message
        self.history.forget()
        self.take(None)

    def on_language_changed(self, message: LanguageChanged) -> None:
        del message
        self.redraw()

    @on(Rows.Highlighted, "GraphList")
    def _highlighted(self) -> None:
        name = self.names.chosen_name
        if name and name != self.history.chosen.get(self.history.kind):
            self.history.choose(name)
            self.redraw()
            self.refresh_bindings()

    def _settle(self) -> None:
        if self.index.settle():
            self.redraw()

    @on(Rows.Opened, "GraphList")
    async def _opened(self) -> None:
        here = self.history.here
        finding = self.index.finding(here.name) if here is not None and here.kind is GraphKind.FINDING else None
        if finding is not None:
            await self.go(goal_of(finding, self.feed.update))
        elif self.pane is not None:
            self.pane.first().focus()

    @on(Rows.Opened, ".graph-links")
    async def _followed(self, message: Rows.Opened) -> None:
        place = GraphPlace.of_key(message.key)
        if place is not None:
            await self.go(place)

    @on(TabLine.Selected)
    def _selected(self, message: TabLine.Selected) -> None:
        self.list_kind(GraphKind(message.key))

    @on(Input.Changed, "#graph-filter")
    def _filter_changed(self) -> None:
        self.redraw()

    @on(Input.Submitted, "#graph-filter")
    def _filter_done(self) -> None:
        self.names.focus()

    # Actions

    async def go(self, place: GraphPlace) -> None:
        if place.kind is GraphKind.TOPIC:
            await self.deck.show_screen("topics")
            cast("Any", self.app.get_screen("topics")).show_topic(place.name)
            return
        self.history.go(place)
        self._arrive()

    def go_back(self) -> None:
        """Go back to where the last link was followed, otherwise to the list."""
        in_list = self.focused is self.names
        if self.focused is self.filter or (in_list and self.filter.value):
            self.filter.value = ""
            self.names.focus()
        elif not in_list:
            self.names.focus()
        elif self.history.back():
            self._arrive()

    def _arrive(self) -> None:
        """Show the chosen place, even if a filter or the lack of `everything` hides it."""
        here = self.history.here
        if here is not None and not self.index.reveal(here, self.filter.value):
            self.filter.value = ""
        self.redraw()
        self.names.focus()
        self.refresh_bindings()

    def list_kind(self, kind: GraphKind) -> None:
        self.history.kind = kind
        self.redraw()
        self.names.focus()
        self.refresh_bindings()

    def list_next(self, by: int) -> None:
        """List the kind this many tabs to the right; left of a detail is the list."""
        if self.focused not in {self.names, None}:
            if by < 0:
                self.names.focus()
            return
        at = LISTED.index(self.history.kind) + by
        self.list_kind(LISTED[at % len(LISTED)])

    async def ros2_command(self) -> str:
        return "" if self.pane is None else self.pane.ros2_command()

    @work(group="load", exit_on_error=False)
    async def toggle_everything(self) -> None:
        self.index.everything = not self.index.everything
        self.redraw()
        if self.index.everything:
            # This reads the directories of all packages.
            await self.index.find_installed()
            self.take(self.feed.update)

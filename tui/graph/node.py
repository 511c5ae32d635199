"""A node: its process, its lifecycle, whom it talks to, and on request its parameters."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from typing import Any, ClassVar

from textual import getters, on
from textual.app import App, ComposeResult
from textual.widget import Widget

from graph.data import GraphUpdate, NodeRow
from graph.housekeeping import is_housekeeping
from graph.inner_states import LifecycleRow
from graph.observer.requests import ChangeState
from launcher.status import NodeStatus
from text import ros2_words
from text.i18n import N_, _, localized
from text.plain import plain
from tui.dialogs.choice import ChoiceScreen
from tui.frame.host import host_of
from tui.graph import parameter_changes
from tui.graph.index import GraphKind, GraphPlace
from tui.graph.pane import LONGEST, GraphPane, heading, link
from tui.graph.parameters import GraphParameters
from tui.log_level import change_log_level
from tui.widgets.node_words import memory, percent, state_words, why
from tui.widgets.rows import Row, Rows


class NodePane(GraphPane):
    """Links above, and parameters below if they were requested."""

    DEFAULT_CSS: ClassVar[str] = """
    NodePane {
        GraphParameters { height: 1fr; display: none; border-top: solid $panel; }
        &.-parameters GraphParameters { display: block; }
    }
    .-low NodePane.-parameters, .-flat NodePane.-parameters {
        GraphLinks { display: none; }
        GraphParameters { border-top: none; }
    }
    """
    transitions: tuple[str, ...] = ()
    """Those of its lifecycle that are possible now; empty if it has none."""

    def compose(self) -> ComposeResult:
        yield from super().compose()
        yield GraphParameters()

    parameters = getters.query_one(GraphParameters)

    @property
    def shows_parameters(self) -> bool:
        return self.has_class("-parameters")

    def show_name(self, name: str) -> None:
        """Show another node; read its parameters if those of the previous one were shown."""
        another = name != self.name_shown
        super().show_name(name)
        if another:
            self.parameters.forget()
            if self.shows_parameters:
                self._read()

    def toggle_parameters(self) -> None:
        self.toggle_class("-parameters")
        if self.shows_parameters:
            self._read()
            self.parameters.table.focus()
        else:
            self.links.focus()
        self.screen.refresh_bindings()

    def _read(self) -> None:
        self.parameters.read(self.name_shown)
        self.redraw()

    def change_lifecycle(self) -> None:
        row = lifecycle_of(self.graph_now, self.name_shown)
        if row is not None and row.transitions:
            change_lifecycle(self.app, row)

    def change_level(self) -> None:
        self.run_worker(change_log_level(self.app, self.name_shown), exit_on_error=False)

    def save_parameters(self) -> None:
        parameter_changes.save(self.app, self.parameters)

    def load_parameters(self) -> None:
        parameter_changes.load(self.app, self.parameters)

    def ros2_command(self) -> str:
        if not self.name_shown:
            return ""
        if not self.shows_parameters:
            return ros2_words.node_info(self.name_shown)
        chosen = self.parameters.chosen
        if chosen is None:
            return ros2_words.parameters(self.name_shown)
        return ros2_words.parameter(self.name_shown, chosen.name)

    @on(Rows.Opened, "#graph-parameters")
    def _edit(self) -> None:
        parameter_changes.edit(self.app, self.parameters)

    def redraw(self) -> None:
        if not self.name_shown or not self.is_mounted:
            return
        update = self.graph_now
        nodes = () if update is None else update.nodes
        node = next((row for row in nodes if row.name == self.name_shown), None)
        status = status_of(self.name_shown, self.deck.feed.nodes)
        if status and not status.state.alive and self.name_shown in self.deck.feed.outside.now:
            # Somebody else's node of that name runs in its place.
            status = None
        lifecycle = lifecycle_of(update, self.name_shown)
        facts = (process_words(status), lifecycle_words(lifecycle))
        self.head.show(self.name_shown, *facts)
        possible = () if lifecycle is None else lifecycle.transitions
        if possible != self.transitions:
            self.transitions = possible
            self.screen.refresh_bindings()
        if self.shows_parameters:
            self.parameters.see(() if node is None else node.processes)
        words = self.notice
        if update is None or node is None:
            gone = _("It was stopped, or cannot be reached any more. Below is what it last did.")
            if status is not None:
                gone = _("Deck started it: the screens Deck and Logs show what happened to it.")
            words.show(_("this node has left the graph"), gone)
            words.display = True
            return
        rows = component_rows(update, node.name) + node_rows(update, node, everything=self.everything)
        self.links.show_links(rows)
        words.display = not rows
        if not rows:
            words.show(_("it talks to nobody"), _("It neither publishes nor subscribes, serves nor calls anything."))

    def first(self) -> Widget:
        return self.links if self.links.display else self.parameters.table


def component_rows(update: GraphUpdate, node: str) -> list[Row]:
    """Return what the node of this full name holds, and what holds it; nothing for most nodes."""
    rows: list[Row] = []
    for container in update.containers:
        if container.node == node:
            title = _("Contains") if container.components else _("An empty container")
            if container.error:
                title += f" · {plain(localized(container.error), LONGEST)}"
            rows.append(heading(title))
            rows += [
                link(GraphPlace(GraphKind.NODE, each.node), "holds", _("component {n}").format(n=each.unique_id))
                for each in container.components
            ]
        elif any(each.node == node for each in container.components):
            rows += [heading(_("Is in the container")), link(GraphPlace(GraphKind.NODE, container.node), "in")]
    return rows


def node_rows(update: GraphUpdate, node: NodeRow, *, everything: bool) -> list[Row]:
    """Return a section for each kind of connection that the node has.

    Each row has the nodes at the other end; ROS's own topics and services are there if `everything`.
    """
    sections = (
        (GraphKind.TOPIC, "says", _("Publishes"), node.publishes, "subscribes", "→"),
        (GraphKind.TOPIC, "hears", _("Subscribes to"), node.subscribes, "publishes", "←"),
        (GraphKind.SERVICE, "serves", _("Serves"), node.services, "clients", "←"),
        (GraphKind.SERVICE, "calls", _("Calls"), node.clients, "services", "→"),
        (GraphKind.ACTION, "takes", _("Receives goals from"), node.action_servers, "action_clients", "←"),
        (GraphKind.ACTION, "sends", _("Sends goals to"), node.action_clients, "action_servers", "→"),
    )
    rows: list[Row] = []
    for kind, section, title, all_names, end, arrow in sections:
        names = [name for name in sorted(all_names) if everything or not is_housekeeping(name)]
        rows += [heading(title)] if names else []
        for name in names:
            others = (row.name.removeprefix("/") for row in update.nodes if name in getattr(row, end))
            told = ", ".join(plain(other, LONGEST) for other in others)
            rows.append(link(GraphPlace(kind, name), section, f"{arrow} {told}" if told else _("nobody")))
    return rows


def status_of(name: str, nodes: Mapping[str, NodeStatus]) -> NodeStatus | None:
    return nodes.get(name.removeprefix("/")) or nodes.get(name.rpartition("/")[2])


def process_words(status: NodeStatus | None) -> str:
    if status is None:
        return _("not started by Deck")
    sign, word, _meaning = state_words(status)
    parts = [f"{sign} {_(word)}"]
    if not status.state.alive:
        return f"{parts[0]} · {why(status)}"
    if status.pid is not None:
        parts.append(_("process {pid}").format(pid=status.pid))
    if status.cpu_percent is not None:
        parts.append(_("CPU {share}").format(share=percent(status.cpu_percent)))
    if status.memory_bytes is not None:
        parts.append(memory(status.memory_bytes))
    return " · ".join(parts)


MEANINGS = {
    "configure": N_("read parameters, open devices; it does nothing yet"),
    "activate": N_("do what it is for"),
    "deactivate": N_("pause, ready to go on"),
    "cleanup": N_("let go of all that configure took"),
    "shutdown": N_("end for good; only a restart brings it back"),
}


def lifecycle_of(update: GraphUpdate | None, node: str) -> LifecycleRow | None:
    rows = () if update is None else update.lifecycles
    return next((row for row in rows if row.node == node), None)


def lifecycle_words(row: LifecycleRow | None) -> str:
    """Return its state, what it can do now, or why that is not known; empty without a lifecycle."""
    if row is None:
        return ""
    if not row.state:
        reason = localized(row.error) if row.error else _("the node is being asked")
        return _("lifecycle: {why}").format(why=reason)
    words = _("lifecycle: {state}").format(state=row.state)
    if row.error:
        return f"{words} · {localized(row.error)}"
    if row.transitions:
        words += " · " + _("can {transitions}").format(transitions=", ".join(row.transitions))
    return words


def change_lifecycle(app: App[Any], row: LifecycleRow) -> None:
    """Ask which of the possible transitions the node is to make, and have it made."""

    def take(transition: str | None) -> None:
        if transition:
            app.run_worker(_change(app, row.node, transition), exit_on_error=False)

    width = max(map(len, row.transitions))
    choices = {
        each: plain(f"{each:<{width}}  {_(MEANINGS[each])}" if each in MEANINGS else each, LONGEST)
        for each in row.transitions
    }
    dialog = ChoiceScreen(
        lambda: _("Lifecycle of {node}").format(node=plain(row.node, LONGEST)),
        lambda: _("It is {state}. What is it to do?").format(state=plain(row.state)),
        choices,
    )
    app.push_screen(dialog, take)


async def _change(app: App[Any], node: str, transition: str) -> None:
    graph = host_of(app).feed.graph
    if graph is None:
        return
    result = await asyncio.wrap_future(graph.ask(ChangeState(node, transition)))
    words = localized(result.error) or _("{node} is {state} now").format(node=node, state=result.state)
    app.notify(plain(words, LONGEST), severity="warning" if result.error else "information", markup=False)

"""A node: its process, its connections, and on request its parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual import on

from text import ros2_words
from text.i18n import _
from tui.graph import parameter_changes
from tui.graph.components import component_rows
from tui.graph.lifecycle import change_lifecycle, lifecycle_of, lifecycle_words
from tui.graph.links import GraphLinks, heading, link, short
from tui.graph.neighbours import neighbours, node_called
from tui.graph.pane import EmptyNotice, GraphPane
from tui.graph.parameters import GraphParameters
from tui.log_level import change_log_level
from tui.widgets.name_head import NameHead
from tui.widgets.node_words import memory, percent, state_words, why
from tui.widgets.rows import Rows

if TYPE_CHECKING:
    from collections.abc import Mapping

    from textual.app import ComposeResult
    from textual.widget import Widget

    from graph.data import GraphUpdate, NodeRow
    from launcher.status import NodeStatus
    from tui.graph.neighbours import Connection
    from tui.widgets.rows import Row


class NodePane(GraphPane):
    """Links above, and parameters below if they were requested."""

    DEFAULT_CSS: ClassVar[str] = """
    NodePane {
        GraphLinks { height: 1fr; }
        GraphParameters { height: 1fr; display: none; border-top: solid $panel; }
        &.-parameters GraphParameters { display: block; }
    }
    .-low NodePane.-parameters, .-flat NodePane.-parameters {
        GraphLinks, #node-words { display: none; }
        GraphParameters { border-top: none; }
    }
    """

    _transitions: tuple[str, ...] = ()
    """Those of its lifecycle that are possible now."""

    def compose(self) -> ComposeResult:
        yield NameHead()
        yield EmptyNotice(id="node-words")
        yield GraphLinks()
        yield GraphParameters()

    @property
    def links(self) -> GraphLinks:
        return self.query_one(GraphLinks)

    @property
    def parameters(self) -> GraphParameters:
        return self.query_one(GraphParameters)

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
        """Show the parameters, after reading them again, or hide them."""
        self.toggle_class("-parameters")
        if self.shows_parameters:
            self._read()
            self.parameters.table.focus()
        else:
            self.links.focus()
        self.screen.refresh_bindings()

    @property
    def can_change(self) -> bool:
        """Whether the node has a lifecycle in which it can make a transition now."""
        row = lifecycle_of(self.graph_now, self.name_shown)
        return row is not None and bool(row.transitions)

    def change_lifecycle(self) -> None:
        """Ask which transition the node is to make."""
        row = lifecycle_of(self.graph_now, self.name_shown)
        if row is not None and row.transitions:
            change_lifecycle(self.app, row)

    def change_level(self) -> None:
        """Ask the node for its log level, and change it."""
        self.run_worker(change_log_level(self.app, self.name_shown), exit_on_error=False)

    def ros2_command(self) -> str:
        """Return what tells of the node, or reads its parameters or the chosen one."""
        if not self.name_shown:
            return ""
        if not self.shows_parameters:
            return ros2_words.node_info(self.name_shown)
        chosen = self.parameters.chosen
        if chosen is None:
            return ros2_words.parameters(self.name_shown)
        return ros2_words.parameter(self.name_shown, chosen.name)

    def save_parameters(self) -> None:
        """Ask for a file, and save the parameters to it."""
        parameter_changes.save(self.app, self.parameters)

    def load_parameters(self) -> None:
        """Ask for a file, and set the parameters that it has for this node."""
        parameter_changes.load(self.app, self.parameters)

    @on(Rows.Opened, "#graph-parameters")
    def _edit(self) -> None:
        parameter_changes.edit(self.app, self.parameters)

    def _read(self) -> None:
        self.parameters.read(self.name_shown)
        self.redraw()

    def redraw(self) -> None:
        """Show the current state of the node."""
        if not self.name_shown or not self.is_mounted:
            return
        update = self.graph_now
        node = node_called(update, self.name_shown)
        status = status_of(self.name_shown, self.deck.feed.nodes)
        if status and not status.state.alive and self.name_shown in self.deck.feed.outside.now:
            # Somebody else's node of that name runs in its place.
            status = None
        lifecycle = lifecycle_of(update, self.name_shown)
        facts = (process_words(status), lifecycle_words(lifecycle))
        self.query_one(NameHead).show(self.name_shown, *facts)
        self._note_transitions(() if lifecycle is None else lifecycle.transitions)
        if self.shows_parameters:
            self.parameters.see(() if node is None else node.processes)
        words = self.query_one(EmptyNotice)
        if update is None or node is None:
            words.show(_("this node has left the graph"), _gone_words(status is not None))
            words.display = True
            return
        rows = component_rows(update, node.name)
        rows += node_rows(update, node, everything=self.everything)
        self.links.show_links(rows)
        words.display = not rows
        if not rows:
            words.show(_("it talks to nobody"), _("It neither publishes nor subscribes, serves nor calls anything."))

    def _note_transitions(self, possible: tuple[str, ...]) -> None:
        if possible != self._transitions:
            self._transitions = possible
            self.screen.refresh_bindings()

    def relabel(self) -> None:
        """Redraw in the current language."""
        self.parameters.redraw()
        self.redraw()

    def first(self) -> Widget:
        """Return the parameters if nothing else is visible, otherwise the links."""
        return self.links if self.links.display else self.parameters.table


def _gone_words(ours: bool) -> str:
    if ours:
        return _("Deck started it: the screens Deck and Logs show what happened to it.")
    return _("It was stopped, or cannot be reached any more. Below is what it last did.")


def node_rows(update: GraphUpdate, node: NodeRow, *, everything: bool) -> list[Row]:
    """Return a section for each kind of connection that the node has."""
    around = neighbours(update, node, everything=everything)
    sections: tuple[tuple[str, str, tuple[Connection, ...], str], ...] = (
        ("says", _("Publishes"), around.said, "→"),
        ("hears", _("Subscribes to"), around.heard, "←"),
        ("serves", _("Serves"), around.served, "←"),
        ("calls", _("Calls"), around.called, "→"),
        ("takes", _("Receives goals from"), around.goals_taken, "←"),
        ("sends", _("Sends goals to"), around.goals_sent, "→"),
    )
    rows: list[Row] = []
    for section, title, connections, arrow in sections:
        if connections:
            rows.append(heading(title))
            rows += [link(connection.place, section, _with(connection, arrow)) for connection in connections]
    return rows


def _with(connection: Connection, arrow: str) -> str:
    """Return who is at the other end; for a topic, say so if there is nobody."""
    names = ", ".join(short(name) for name in connection.nodes)
    return f"{arrow} {names}" if names else _("nobody")


def status_of(name: str, nodes: Mapping[str, NodeStatus]) -> NodeStatus | None:
    """Return the status of the node with this full name, if Deck has started one."""
    return nodes.get(name.removeprefix("/")) or nodes.get(name.rpartition("/")[2])


def process_words(status: NodeStatus | None) -> str:
    """Return which of Deck's processes a node is, and the resources it uses."""
    if status is None:
        return _("not started by Deck")
    sign, word, _meaning = state_words(status)
    if not status.state.alive:
        return f"{sign} {_(word)} · {why(status)}"
    parts = [f"{sign} {_(word)}"]
    if status.pid is not None:
        parts.append(_("process {pid}").format(pid=status.pid))
    if status.cpu_percent is not None:
        parts.append(_("CPU {share}").format(share=percent(status.cpu_percent)))
    if status.memory_bytes is not None:
        parts.append(memory(status.memory_bytes))
    return " · ".join(parts)

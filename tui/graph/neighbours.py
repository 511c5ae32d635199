"""Who talks to a node and whom it talks to: its immediate neighbourhood in the graph."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from graph.housekeeping import is_housekeeping
from tui.graph.places import GraphKind, GraphPlace

if TYPE_CHECKING:
    from collections.abc import Iterable

    from graph.data import GraphUpdate, NodeRow


@dataclass(frozen=True)
class Connection:
    """A topic, a service or an action, and the nodes at its other end."""

    place: GraphPlace
    nodes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Neighbours:
    """The connections that lead to a node, and those that lead away from it.

    What it subscribes to, serves, and receives goals for leads to it; what it publishes, calls, and
    sends goals to leads away from it.
    """

    heard: tuple[Connection, ...] = ()
    served: tuple[Connection, ...] = ()
    goals_taken: tuple[Connection, ...] = ()
    said: tuple[Connection, ...] = ()
    called: tuple[Connection, ...] = ()
    goals_sent: tuple[Connection, ...] = ()

    @property
    def coming(self) -> tuple[Connection, ...]:
        return (*self.heard, *self.served, *self.goals_taken)

    @property
    def going(self) -> tuple[Connection, ...]:
        return (*self.said, *self.called, *self.goals_sent)


def node_called(update: GraphUpdate | None, name: str) -> NodeRow | None:
    """Return the node with this full name."""
    nodes = () if update is None else update.nodes
    return next((row for row in nodes if row.name == name), None)


def neighbours(update: GraphUpdate, node: NodeRow, *, everything: bool = False) -> Neighbours:
    """Return the neighbours of a node; with ROS's own topics and services if `everything`."""

    def connections(kind: GraphKind, names: Iterable[str], end: str) -> tuple[Connection, ...]:
        return tuple(
            Connection(GraphPlace(kind, name), _with(update, end, name))
            for name in sorted(names)
            if everything or not is_housekeeping(name)
        )

    return Neighbours(
        heard=connections(GraphKind.TOPIC, node.subscribes, "publishes"),
        served=connections(GraphKind.SERVICE, node.services, "clients"),
        goals_taken=connections(GraphKind.ACTION, node.action_servers, "action_clients"),
        said=connections(GraphKind.TOPIC, node.publishes, "subscribes"),
        called=connections(GraphKind.SERVICE, node.clients, "services"),
        goals_sent=connections(GraphKind.ACTION, node.action_clients, "action_servers"),
    )


def _with(update: GraphUpdate, end: str, name: str) -> tuple[str, ...]:
    """Return the nodes with `name` at this end of theirs: `publishes`, and so on."""
    return tuple(row.name for row in update.nodes if name in getattr(row, end))

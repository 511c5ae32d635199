"""Nodes with what they publish, serve and call; services and actions with the nodes that use them.

An action consists of three services and two topics under hidden names; here it is one thing again.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from graph.data import ActionRow, NodeRow, ServiceRow
from graph.scan.endpoints import full_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from rclpy.node import Node

    from graph.scan.endpoints import TopicEnds

INNER = "/_action/"
SEND_GOAL = "/_action/send_goal"
SEND_GOAL_TYPE = "_SendGoal"
"""Source: ROS 2 design, "Actions", the names of an action's services and their types."""


@dataclass(frozen=True)
class ServicesAndActions:
    """The services that one node serves, or that it calls: name to types."""

    services: dict[str, tuple[str, ...]] = field(default_factory=dict)
    actions: dict[str, tuple[str, ...]] = field(default_factory=dict)


@dataclass(frozen=True)
class NodeServices:
    """The services and actions of one node."""

    serves: ServicesAndActions
    calls: ServicesAndActions


def services_of_nodes(node: Node, own_name: str, serve_urgent: Callable[[], object]) -> dict[str, NodeServices]:
    """Ask the middleware what each node serves and calls; `own_name` is left out."""
    from rclpy.node import NodeNameNonExistentError

    found = {}
    for name, namespace in node.get_node_names_and_namespaces():
        full = full_name(name, namespace)
        if full == own_name:
            continue
        serve_urgent()
        try:
            serves = node.get_service_names_and_types_by_node(name, namespace)
            calls = node.get_client_names_and_types_by_node(name, namespace)
        except NodeNameNonExistentError:
            # It left between the queries.
            continue
        found[full] = NodeServices(services_and_actions(serves), services_and_actions(calls))
    return found


def services_and_actions(names_and_types: Iterable[tuple[str, Iterable[str]]]) -> ServicesAndActions:
    """Separate ordinary services from those inside an action."""
    sorted_out = ServicesAndActions()
    for name, types in sorted(names_and_types):
        if INNER not in name:
            sorted_out.services[name] = tuple(types)
        elif name.endswith(SEND_GOAL):
            action_types = tuple(kind.removesuffix(SEND_GOAL_TYPE) for kind in types)
            sorted_out.actions[name.removesuffix(SEND_GOAL)] = action_types
    return sorted_out


def node_rows(topics: Mapping[str, TopicEnds], found: Mapping[str, NodeServices]) -> tuple[NodeRow, ...]:
    """Return a row for each node, sorted by name."""
    publishes: defaultdict[str, set[str]] = defaultdict(set)
    subscribes: defaultdict[str, set[str]] = defaultdict(set)
    processes: defaultdict[str, set[int]] = defaultdict(set)
    for topic in topics.values():
        for end in topic.publishers:
            publishes[end.node].add(topic.name)
        for end in topic.subscribers:
            subscribes[end.node].add(topic.name)
        for end in (*topic.publishers, *topic.subscribers):
            if end.process is not None:
                processes[end.node].add(end.process)
    return tuple(
        NodeRow(
            name,
            tuple(sorted(publishes[name])),
            tuple(sorted(subscribes[name])),
            tuple(one.serves.services),
            tuple(one.calls.services),
            tuple(one.serves.actions),
            tuple(one.calls.actions),
            tuple(sorted(processes[name])),
        )
        for name, one in sorted(found.items())
    )


def service_rows(found: Mapping[str, NodeServices]) -> tuple[ServiceRow, ...]:
    """Return a row for each service that somebody serves, sorted by name."""
    types: defaultdict[str, set[str]] = defaultdict(set)
    nodes: defaultdict[str, list[str]] = defaultdict(list)
    for node, one in sorted(found.items()):
        for name, kinds in one.serves.services.items():
            types[name] |= set(kinds)
            nodes[name].append(node)
    called: defaultdict[str, set[str]] = defaultdict(set)
    for one in found.values():
        for name, kinds in one.calls.services.items():
            called[name] |= set(kinds)
    return tuple(
        ServiceRow(name, tuple(sorted(types[name])), tuple(nodes[name]), tuple(sorted(called[name] - types[name])))
        for name in sorted(nodes)
    )


def action_rows(found: Mapping[str, NodeServices]) -> tuple[ActionRow, ...]:
    """Return a row for each action that somebody serves or calls, sorted by name."""
    types: defaultdict[str, set[str]] = defaultdict(set)
    servers: defaultdict[str, list[str]] = defaultdict(list)
    clients: defaultdict[str, list[str]] = defaultdict(list)
    for node, one in sorted(found.items()):
        for services, nodes in ((one.serves, servers), (one.calls, clients)):
            for name, kinds in services.actions.items():
                types[name] |= set(kinds)
                nodes[name].append(node)
    return tuple(
        ActionRow(name, tuple(sorted(types[name])), tuple(servers[name]), tuple(clients[name]))
        for name in sorted(types)
    )

"""The graph as the middleware of this process knows it: who is there, and who talks to whom.

Everything comes from local tables: no node has to answer, so none can cause a delay.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from graph.ros import ONLY_LISTENING
from graph.scan.endpoints import TopicEnds, publishers, subscriptions
from graph.scan.nodes import action_rows, node_rows, service_rows, services_of_nodes

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.node import Node

    from graph.data import ActionRow, NodeRow, ServiceRow

Signature = tuple[Any, ...]
"""Changes when the graph has changed; cheap to compute."""


@dataclass(frozen=True)
class Scan:
    """The whole graph at one moment."""

    topics: dict[str, TopicEnds] = field(default_factory=dict)
    nodes: tuple[NodeRow, ...] = ()
    services: tuple[ServiceRow, ...] = ()
    actions: tuple[ActionRow, ...] = ()


def is_complete(seen: Scan) -> bool:
    """Return whether the node of every endpoint is known."""
    return all(end.is_named for topic in seen.topics.values() for end in (*topic.publishers, *topic.subscribers))


def signature(node: Node) -> Signature:
    """Return something that differs as soon as an endpoint, node or service has come or gone."""
    handle = node.handle
    return (
        tuple(
            (name, tuple(types), handle.get_count_publishers(name), handle.get_count_subscribers(name))
            for name, types in node.get_topic_names_and_types()
        ),
        tuple(node.get_node_names_and_namespaces()),
        tuple(
            (name, tuple(types), handle.get_count_services(name), handle.get_count_clients(name))
            for name, types in node.get_service_names_and_types()
        ),
    )


def scan(node: Node, own_name: str, serve_urgent: Callable[[], object]) -> Scan:
    """Ask the middleware for everything; `own_name` is Deck's node, which is left out.

    This takes a tenth of a second for fifteen nodes: `serve_urgent` is called often in between.
    """
    topics = {}
    for name, types in node.get_topic_names_and_types():
        serve_urgent()
        topics[name] = _topic(node, own_name, name, tuple(types))
    found = services_of_nodes(node, own_name, serve_urgent)
    return Scan(topics, node_rows(topics, found), service_rows(found), action_rows(found))


def _topic(node: Node, own_name: str, name: str, types: tuple[str, ...]) -> TopicEnds:
    publishing = publishers(node, name)
    subscribed = subscriptions(node, name)
    # A recorder that hears the emergency stop must not pass for somebody who obeys it.
    listening = tuple(end for end in subscribed if not end.node.startswith(ONLY_LISTENING))
    return TopicEnds(
        name,
        types,
        tuple(end for end in publishing if end.node != own_name),
        listening,
        tuple(end for end in publishing if end.node == own_name),
        len(subscribed) - len(listening),
    )

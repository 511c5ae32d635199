"""The graph as the middleware of this process knows it: who is there, and who talks to whom.

All of it is answered from local tables: no node has to answer, so none can hold it up.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from graph.data import EndpointInfo, NodeRow, ServiceRow

if TYPE_CHECKING:
    from rclpy.node import Node

NAMELESS = "_NODE_NAME_UNKNOWN_"
"""Source: rmw, `get_topic_endpoint_info.h`."""
Signature = tuple[Any, ...]
"""Changes when the graph has changed; cheap to make."""


@dataclass(frozen=True)
class TopicEnds:
    """One topic with its endpoints, Deck's own apart."""

    name: str
    type_names: tuple[str, ...]
    publishers: tuple[EndpointInfo, ...] = ()
    subscribers: tuple[EndpointInfo, ...] = ()
    own_publishers: tuple[EndpointInfo, ...] = ()

    @property
    def everyone_publishing(self) -> tuple[EndpointInfo, ...]:
        """All publishers, Deck's own included."""
        return self.publishers + self.own_publishers

    @property
    def is_deserted(self) -> bool:
        """Whether nobody but Deck knows this topic."""
        return not self.publishers and not self.subscribers


@dataclass(frozen=True)
class Scan:
    """The whole graph at one moment."""

    topics: dict[str, TopicEnds] = field(default_factory=dict)
    nodes: tuple[NodeRow, ...] = ()
    services: tuple[ServiceRow, ...] = ()


def is_complete(seen: Scan) -> bool:
    """Tell whether every endpoint has a node; its name comes a little later than the endpoint."""
    return not any(
        end.node.endswith(NAMELESS)
        for topic in seen.topics.values()
        for end in (*topic.publishers, *topic.subscribers)
    )


def signature(node: Node) -> Signature:
    """Return something that differs as soon as an endpoint, node or service has come or gone."""
    topics = node.get_topic_names_and_types()
    return (
        tuple(
            (
                name,
                tuple(types),
                node.handle.get_count_publishers(name),
                node.handle.get_count_subscribers(name),
            )
            for name, types in topics
        ),
        tuple(node.get_node_names_and_namespaces()),
        tuple((name, tuple(types)) for name, types in node.get_service_names_and_types()),
    )


def scan(node: Node, own_name: str) -> Scan:
    """Ask the middleware for everything; `own_name` is Deck's node, which is left out."""
    topics = {
        name: _topic(node, own_name, name, tuple(types))
        for name, types in node.get_topic_names_and_types()
    }
    served = _services_by_node(node, own_name)
    return Scan(topics, _nodes(topics, served), _services(node, served))


def _topic(node: Node, own_name: str, name: str, types: tuple[str, ...]) -> TopicEnds:
    publishers = [_endpoint(info) for info in node.get_publishers_info_by_topic(name)]
    subscribers = [_endpoint(info) for info in node.get_subscriptions_info_by_topic(name)]
    return TopicEnds(
        name,
        types,
        tuple(end for end in publishers if end.node != own_name),
        tuple(end for end in subscribers if end.node != own_name),
        tuple(end for end in publishers if end.node == own_name),
    )


def _endpoint(info: Any) -> EndpointInfo:  # noqa: ANN401 - rclpy.topic_endpoint_info
    qos = info.qos_profile
    return EndpointInfo(
        full_name(info.node_name, info.node_namespace),
        info.topic_type,
        qos.reliability.name.lower(),
        qos.durability.name.lower(),
        qos.depth,
    )


def full_name(name: str, namespace: str) -> str:
    """Return `/arm/sonar` for the node `sonar` in the namespace `/arm`."""
    return f"{namespace.rstrip('/')}/{name}"


def _services_by_node(node: Node, own_name: str) -> dict[str, tuple[str, ...]]:
    from rclpy.node import NodeNameNonExistentError

    served = {}
    for name, namespace in node.get_node_names_and_namespaces():
        full = full_name(name, namespace)
        if full == own_name:
            continue
        try:
            services = node.get_service_names_and_types_by_node(name, namespace)
        except NodeNameNonExistentError:
            # It went between the two questions.
            continue
        served[full] = tuple(sorted(service for service, _ in services))
    return served


def _nodes(topics: dict[str, TopicEnds], served: dict[str, tuple[str, ...]]) -> tuple[NodeRow, ...]:
    publishes: defaultdict[str, set[str]] = defaultdict(set)
    subscribes: defaultdict[str, set[str]] = defaultdict(set)
    for topic in topics.values():
        for end in topic.publishers:
            publishes[end.node].add(topic.name)
        for end in topic.subscribers:
            subscribes[end.node].add(topic.name)
    return tuple(
        NodeRow(name, tuple(sorted(publishes[name])), tuple(sorted(subscribes[name])), served[name])
        for name in sorted(served)
    )


def _services(node: Node, served: dict[str, tuple[str, ...]]) -> tuple[ServiceRow, ...]:
    serving: defaultdict[str, list[str]] = defaultdict(list)
    for name, services in served.items():
        for service in services:
            serving[service].append(name)
    return tuple(
        ServiceRow(name, tuple(types), tuple(sorted(serving[name])))
        for name, types in sorted(node.get_service_names_and_types())
        if serving[name]
    )

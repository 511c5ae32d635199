"""The graph as the middleware of this process knows it: endpoints, nodes, who talks to whom.

Everything comes from local tables: no node has to answer, so none can cause a delay. An action consists of three
services and two topics under hidden names; here it is one thing again. For use on the node's thread only.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from graph.data import ActionRow, EndpointInfo, NodeRow, ServiceRow
from graph.ros import ONLY_LISTENING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from rclpy.duration import Duration
    from rclpy.node import Node


INFINITE_NS = 2**63 - 1
"""Source: rmw, `RMW_DURATION_INFINITE` in time.h; 0 there means that the policy was not set."""
NANOSECONDS = 1e-9
HISTORIES = frozenset({"keep_last", "keep_all"})
FAST_DDS = b"\x01\x0f"
"""First bytes of every identifier from eProsima. Source: OMG, "DDS Vendor IDs"."""
LIVELINESS = frozenset({"automatic", "manual_by_topic"})


@dataclass(frozen=True)
class TopicEnds:
    """One topic with its endpoints, except Deck's own."""

    name: str
    type_names: tuple[str, ...]
    publishers: tuple[EndpointInfo, ...] = ()
    subscribers: tuple[EndpointInfo, ...] = ()
    own_publishers: tuple[EndpointInfo, ...] = ()
    passive_subscriptions: int = field(default=0, compare=False)
    """Subscriptions that only show or record; a change among them does not change the graph."""

    @property
    def everyone_publishing(self) -> tuple[EndpointInfo, ...]:
        """All publishers, including Deck's own."""
        return self.publishers + self.own_publishers

    @property
    def is_deserted(self) -> bool:
        """Whether nobody but Deck uses this topic."""
        return not self.publishers and not self.subscribers


def publishers(node: Node, topic: str) -> list[EndpointInfo]:
    """Return the publishers of the topic, including Deck's."""
    from rclpy.impl.implementation_singleton import rclpy_implementation as rclpy_c

    # rclpy's own objects cost four times as much: 20 ms per scan of a hundred topics.
    with node.handle:
        told = rclpy_c.rclpy_get_publishers_info_by_topic(node.handle, topic, False)
    return [_endpoint(info) for info in told]


def subscriptions(node: Node, topic: str) -> list[EndpointInfo]:
    """Return the subscriptions to the topic, including Deck's."""
    from rclpy.impl.implementation_singleton import rclpy_implementation as rclpy_c

    with node.handle:
        told = rclpy_c.rclpy_get_subscriptions_info_by_topic(node.handle, topic, False)
    return [_endpoint(info) for info in told]


def full_name(name: str, namespace: str) -> str:
    """Return `/arm/sonar` for the node `sonar` in the namespace `/arm`."""
    return f"{namespace.rstrip('/')}/{name}"


def _endpoint(info: dict[str, Any]) -> EndpointInfo:
    qos, gid = info["qos_profile"], bytes(info["endpoint_gid"])
    history, reliability, durability, liveliness = _names(
        qos["history"], qos["reliability"], qos["durability"], qos["liveliness"]
    )
    return EndpointInfo(
        full_name(info["node_name"], info["node_namespace"]),
        info["topic_type"],
        reliability,
        durability,
        qos["depth"],
        history,
        _seconds(qos["deadline"]),
        _seconds(qos["lifespan"]),
        _seconds(qos["liveliness_lease_duration"]),
        liveliness,
        _process(gid),
        gid,
    )


def _process(gid: bytes) -> int | None:
    """Return the lower half of the number of the process that an endpoint belongs to.

    Source: Fast DDS, `guid_prefix_create`: vendor, host, process and random, two bytes each.
    """
    return int.from_bytes(gid[4:6], "little") if gid.startswith(FAST_DDS) else None


@lru_cache(maxsize=64)
def _names(history: int, reliability: int, durability: int, liveliness: int) -> tuple[str, str, str, str]:
    """Return the names of these policy numbers, empty for an unreported history."""
    from rclpy.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, ReliabilityPolicy

    kept = HistoryPolicy(history).name.lower()
    alive = LivelinessPolicy(liveliness).name.lower()
    return (
        kept if kept in HISTORIES else "",
        ReliabilityPolicy(reliability).name.lower(),
        DurabilityPolicy(durability).name.lower(),
        alive if alive in LIVELINESS else "",
    )


def _seconds(duration: Duration) -> float | None:
    nanoseconds = duration.nanoseconds
    return nanoseconds * NANOSECONDS if 0 < nanoseconds < INFINITE_NS else None


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

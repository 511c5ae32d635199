"""Publishers and subscriptions, with every policy that the middleware reports."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from graph.data import EndpointInfo

if TYPE_CHECKING:
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

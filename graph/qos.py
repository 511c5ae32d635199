"""Which quality of service to ask for, and who on a topic cannot hear whom."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile

    from graph.data import EndpointInfo

RELIABLE = "reliable"
BEST_EFFORT = "best_effort"
TRANSIENT_LOCAL = "transient_local"
VOLATILE = "volatile"


@dataclass(frozen=True)
class Qos:
    """What Deck asks for or offers; the other policies stay at their defaults."""

    reliability: str = RELIABLE
    durability: str = VOLATILE


@dataclass(frozen=True)
class Mismatch:
    """A publisher and a subscriber of one topic that the middleware does not join."""

    policy: str
    """`reliability` or `durability`."""
    publisher: str
    subscriber: str
    offered: str
    requested: str

    def in_words(self) -> str:
        """Return who does not hear whom, and the two ways out."""
        return (
            f"{self.subscriber} does not hear {self.publisher}: it asks for {self.policy} "
            f"{self.requested}, offered is {self.offered}. Make the publisher {self.requested} "
            f"or the subscriber {self.offered}"
        )

    def facts(self) -> dict[str, str]:
        """Return the same as names and values, to be said in another language."""
        return {
            "policy": self.policy,
            "publisher": self.publisher,
            "subscriber": self.subscriber,
            "offered": self.offered,
            "requested": self.requested,
        }


def to_hear(publishers: Sequence[EndpointInfo]) -> Qos:
    """Return the strongest request that every one of these publishers meets."""
    if not publishers:
        return Qos()
    return Qos(
        RELIABLE if all(p.reliability == RELIABLE for p in publishers) else BEST_EFFORT,
        TRANSIENT_LOCAL if all(p.durability == TRANSIENT_LOCAL for p in publishers) else VOLATILE,
    )


def to_be_heard(subscribers: Iterable[EndpointInfo]) -> Qos:
    """Return an offer that meets every one of these subscribers."""
    latched = any(s.durability == TRANSIENT_LOCAL for s in subscribers)
    return Qos(RELIABLE, TRANSIENT_LOCAL if latched else VOLATILE)


def mismatches(
    publishers: Sequence[EndpointInfo], subscribers: Sequence[EndpointInfo]
) -> list[Mismatch]:
    """Return every pair that does not fit, by the rule that an offer may exceed the request.

    Source: ROS 2 documentation, "Quality of Service settings", tables of compatibilities.
    """
    found = []
    for publisher in publishers:
        for subscriber in subscribers:
            if publisher.reliability == BEST_EFFORT and subscriber.reliability == RELIABLE:
                found.append(
                    Mismatch("reliability", publisher.node, subscriber.node, BEST_EFFORT, RELIABLE)
                )
            if publisher.durability == VOLATILE and subscriber.durability == TRANSIENT_LOCAL:
                found.append(
                    Mismatch(
                        "durability", publisher.node, subscriber.node, VOLATILE, TRANSIENT_LOCAL
                    )
                )
    return found


def profile(qos: Qos, depth: int) -> QoSProfile:
    """Return rclpy's own form of it, keeping the last `depth` messages."""
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

    return QoSProfile(
        depth=depth,
        reliability=ReliabilityPolicy[qos.reliability.upper()],
        durability=DurabilityPolicy[qos.durability.upper()],
    )

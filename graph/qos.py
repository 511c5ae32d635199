"""Chooses the quality of service that Deck requests and offers, to be compatible with everybody."""

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
    """The policies that Deck requests or offers; the others keep their defaults."""

    reliability: str = RELIABLE
    durability: str = VOLATILE


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


def profile(qos: Qos, depth: int) -> QoSProfile:
    """Return it as an rclpy profile that keeps the last `depth` messages."""
    from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

    return QoSProfile(
        depth=depth,
        reliability=ReliabilityPolicy[qos.reliability.upper()],
        durability=DurabilityPolicy[qos.durability.upper()],
    )

"""From which topic the pictures of a camera are taken: not the raw ones, where others are offered.

A raw picture of a camera is a megabyte, in hundreds of packets. Over a network the whole of it is
lost with any one of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.heavy_types import COMPRESSED_IMAGE, IMAGE
from graph.qos import BEST_EFFORT, TRANSIENT_LOCAL, Qos, to_hear

if TYPE_CHECKING:
    from collections.abc import Mapping

    from graph.data import EndpointInfo
    from graph.scan import TopicEnds

THINNED = "/_deck/compressed"
"""Added to the name of a topic: where Deck's own relay offers its pictures, small and few."""
OFFERED = (THINNED, "/compressed")
"""What the names of such offers end with, the best first; the second is image_transport's."""
HOST_BYTES = 4
"""Of the identifier of an endpoint: its vendor and its host, two bytes each. Source: see
`graph.scan`."""


def picture_source(topic: str, topics: Mapping[str, TopicEnds]) -> str:
    """Return the topic to subscribe to for the pictures of this one: itself, if none is better."""
    for ending in OFFERED:
        offer = topics.get(topic + ending)
        if offer and COMPRESSED_IMAGE in {end.type_name for end in offer.everyone_publishing}:
            return topic + ending
    return topic


def to_see(ends: TopicEnds) -> Qos:
    """Return the request for pictures: the next one is better than the one that was lost."""
    qos = to_hear(ends.everyone_publishing)
    return qos if qos.durability == TRANSIENT_LOCAL else Qos(BEST_EFFORT)


def raw_from_afar(ends: TopicEnds, host: bytes) -> bool:
    """Whether these are raw pictures that come over a network; `host`: see `host_of`."""
    return IMAGE in ends.type_names and is_away(ends, host)


def is_away(ends: TopicEnds, host: bytes) -> bool:
    """Whether any publisher is on another machine, as far as the middleware tells."""
    return bool(host) and any(host_of(end) != host for end in ends.publishers)


def host_of(end: EndpointInfo) -> bytes:
    """Return what tells the machine of an endpoint from others of the same middleware."""
    return end.gid[:HOST_BYTES]

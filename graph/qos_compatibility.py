"""Finds which endpoints of a topic are incompatible, by which policy, and what to change.

The rule for every policy: an offer may exceed the request, never fall short of it.
Source: ROS 2 documentation, "Quality of Service settings", compatibility tables.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from graph.qos import BEST_EFFORT, RELIABLE, TRANSIENT_LOCAL, VOLATILE

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from graph.data import EndpointInfo

RELIABILITY, DURABILITY, LIVELINESS = "reliability", "durability", "liveliness"
DEADLINE, LEASE = "deadline", "lease"
TIMES = {
    DEADLINE: ("a message", "deadline"),
    LEASE: ("a sign of life", "liveliness lease duration"),
}
"""The policies that are durations, with the event they limit, and their name in words."""
AUTOMATIC, MANUAL = "automatic", "manual_by_topic"


@dataclass(frozen=True)
class Mismatch:
    """A publisher and a subscriber of one topic that the middleware does not connect."""

    policy: str
    """`reliability`, `durability`, `liveliness`, `deadline`, or `lease`: the liveliness lease."""
    publisher: str
    subscriber: str
    offered: str
    """The policy's value, or seconds (`0.5`) for a duration; empty if there is none."""
    requested: str

    def in_words(self) -> str:
        """Return who does not receive from whom, and the two ways to fix it."""
        about = f"{self.subscriber} does not hear {self.publisher}: it asks for"
        let, or_let = f"Let {self.publisher} offer", f"or let {self.subscriber} ask for"
        if self.policy not in TIMES:
            return (
                f"{about} {self.policy} {self.requested}, offered is {self.offered}. "
                f"{let} {self.requested}, {or_let} {self.offered}."
            )
        event, name = TIMES[self.policy]
        offered = f"{self.offered} s" if self.offered else "none"
        at_least = f"{offered} or more" if self.offered else "none"
        return (
            f"{about} {event} at least every {self.requested} s ({name}), offered is {offered}. "
            f"{let} {self.requested} s or less, {or_let} {at_least}."
        )

    def facts(self) -> dict[str, str]:
        """Return the same as names and values, for a sentence in another language."""
        return {
            "policy": self.policy,
            "publisher": self.publisher,
            "subscriber": self.subscriber,
            "offered": self.offered,
            "requested": self.requested,
        }


def mismatches(
    publishers: Sequence[EndpointInfo], subscribers: Sequence[EndpointInfo]
) -> list[Mismatch]:
    """Return every incompatible pair, once for each policy.

    Pairs with different types are left out: no policy would connect them.
    """
    return [
        Mismatch(policy, publisher.called, subscriber.called, offered, requested)
        for publisher in publishers
        for subscriber in subscribers
        if publisher.type_name == subscriber.type_name
        for policy, offered, requested in _short_falls(publisher, subscriber)
    ]


def _short_falls(
    publisher: EndpointInfo, subscriber: EndpointInfo
) -> Iterator[tuple[str, str, str]]:
    """Yield each policy in which the offer falls short of the request, with both values."""
    if publisher.reliability == BEST_EFFORT and subscriber.reliability == RELIABLE:
        yield RELIABILITY, BEST_EFFORT, RELIABLE
    if publisher.durability == VOLATILE and subscriber.durability == TRANSIENT_LOCAL:
        yield DURABILITY, VOLATILE, TRANSIENT_LOCAL
    if _is_longer(publisher.deadline_s, subscriber.deadline_s):
        yield DEADLINE, _text(publisher.deadline_s), _text(subscriber.deadline_s)
    if publisher.liveliness == AUTOMATIC and subscriber.liveliness == MANUAL:
        yield LIVELINESS, AUTOMATIC, MANUAL
    if _is_longer(publisher.lease_s, subscriber.lease_s):
        yield LEASE, _text(publisher.lease_s), _text(subscriber.lease_s)


def _is_longer(offered_s: float | None, requested_s: float | None) -> bool:
    """Return whether the offer comes less often than requested; None means never."""
    return requested_s is not None and (offered_s is None or offered_s > requested_s)


def _text(seconds: float | None) -> str:
    return "" if seconds is None else f"{seconds:.6g}"

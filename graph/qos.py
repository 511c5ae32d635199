"""Quality of service: what Deck requests and offers, to be compatible with everybody, and whose does not fit whose.

An offer may exceed a request, never fall short of it. Source: ROS 2 documentation, "Quality of Service settings",
compatibility tables.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from text.i18n import N_
from text.sentences import say

if TYPE_CHECKING:
    from rclpy.qos import QoSProfile

    from graph.data import EndpointInfo
    from text.sentences import Words

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


RELIABILITY, DURABILITY, LIVELINESS = "reliability", "durability", "liveliness"
DEADLINE, LEASE = "deadline", "lease"
TIMES = (DEADLINE, LEASE)
"""The policies that are durations."""
AUTOMATIC, MANUAL = "automatic", "manual_by_topic"
_WHAT = {
    "": N_("{subscriber} does not hear {publisher}: {policy} {requested} is asked for, {offered} is offered."),
    DEADLINE: N_(
        "{subscriber} does not hear {publisher}: it asks for a message at least every {requested} "
        "(deadline), {offered} is offered."
    ),
    LEASE: N_(
        "{subscriber} does not hear {publisher}: it asks for a sign of life at least every "
        "{requested} (liveliness lease duration), {offered} is offered."
    ),
}


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

    @property
    def what(self) -> Words:
        """Who does not receive from whom, and why."""
        return say(_WHAT.get(self.policy, _WHAT[""]), **self._shown())

    @property
    def mend(self) -> Words:
        """The two ways to fix it."""
        if self.policy not in TIMES:
            template = N_("Let {publisher} offer {requested}, or let {subscriber} ask for {offered}.")
        elif self.offered:
            template = N_("Let {publisher} offer {requested} or less, or let {subscriber} ask for {offered} or more.")
        else:
            template = N_("Let {publisher} offer {requested} or less, or let {subscriber} ask for none.")
        return say(template, **self._shown())

    def _shown(self) -> dict[str, str]:
        values = self.offered, self.requested
        offered, requested = map(_time, values) if self.policy in TIMES else values
        return {**vars(self), "offered": offered, "requested": requested}


def mismatches(publishers: Sequence[EndpointInfo], subscribers: Sequence[EndpointInfo]) -> list[Mismatch]:
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


def _short_falls(publisher: EndpointInfo, subscriber: EndpointInfo) -> Iterator[tuple[str, str, str]]:
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


def _time(seconds: str) -> Words:
    return say("{seconds:g} s", seconds=float(seconds)) if seconds else say("nothing")


def _text(seconds: float | None) -> str:
    return "" if seconds is None else f"{seconds:.6g}"

"""When a stop became known here, and which stops a release frees: those known before it was said.

A release is heard at any time after it was said: by a process that was frozen, over a network that
was cut, from a supervisor that hung. Meanwhile there may have been another stop, which the hearer
knows of, from the topic, from the others, or from the disk, and the one who released does not. So
what a release frees is decided by one clock, that of this computer: the stops that were known here
before the release was said, and no others. A stop that was known later is younger, or may be. Those
that others knew in time they release, and this hearer learns it from them.

A message is of our clock if by it it was said in the last `LATE_NS`. A stop by another clock, or
older, is known since it arrived. Such a release cannot be placed: two equally old ones within
`TOGETHER_NS` tell how far that clock is from ours, a single one frees nothing. So two assumptions
are left: a clock that differs by less than `LATE_NS`, but not by milliseconds, is nobody's; and no
network delays two releases equally, by more than that.
"""

from __future__ import annotations

from typing import NamedTuple

from safety.stop_record import Stop, StopRecord

LATE_NS = 3_000_000_000
"""What is older than this came late, or its clock is another one."""
_AHEAD_NS = 50_000_000
"""Two processes of one computer agree so well."""
_APART_NS, TOGETHER_NS = 300_000_000, 30_000_000_000
"""What was said together, and arrives late, arrives together."""
_EQUAL_NS = 250_000_000


class Heard(NamedTuple):
    """A release as it was heard."""

    said_ns: int
    """Unix time of its message, by the clock of the publisher."""
    heard_ns: int
    """When it arrived at this computer, Unix time."""

    @property
    def age_ns(self) -> int:
        return self.heard_ns - self.said_ns


def known_since(stop: Stop, seen_ns: int) -> int:
    """Return since when a stop is known that arrived, or was written to disk, at this time.

    Since it was said, by our clock: it may have waited for a busy hearer, behind its release.
    """
    return stop.said_ns if 0 <= seen_ns - stop.said_ns <= LATE_NS else seen_ns


class KnownStops:
    """What one node knows: the record, and since when it knows each stop that holds."""

    def __init__(self) -> None:
        self.record = StopRecord()
        self.since_ns: dict[Stop, int] = {}
        """By the clock of this computer, for each stop that holds."""
        self._strange: Heard | None = None
        """The last release that could not be placed."""

    def learn(self, record: StopRecord, seen_ns: int) -> None:
        """Take in what somebody knows, which arrived or was written to disk at this time."""
        for stop in record.held:
            since_ns = known_since(stop, seen_ns)
            self.since_ns[stop] = min(self.since_ns.get(stop, since_ns), since_ns)
        self._hold(self.record.merged(record))

    def _hold(self, record: StopRecord) -> None:
        self.record = record
        self.since_ns = {stop: self.since_ns[stop] for stop in record.held}

    def before(self, said_ns: int) -> frozenset[Stop]:
        """Return the stops that were known before this time."""
        return frozenset(stop for stop, since_ns in self.since_ns.items() if since_ns < said_ns)

    def release(self, heard: Heard, *, was_frozen: bool = False) -> bool:
        """Free the stops that are older than a release; return whether it could be placed.

        `was_frozen`: this process has just stood still, so that nothing it hears tells of a clock.
        """
        said_ns = self._placed(heard, was_frozen=was_frozen)
        if self._was_set_back(heard.heard_ns):
            return False
        if said_ns is not None:
            self._hold(self.record.freed(self.before(said_ns)))
        return said_ns is not None

    def _was_set_back(self, now_ns: int) -> bool:
        """Whether our clock was set back since a stop became known: then that is known from now."""
        was_set_back = any(since_ns > now_ns for since_ns in self.since_ns.values())
        self.since_ns = {stop: min(since_ns, now_ns) for stop, since_ns in self.since_ns.items()}
        return was_set_back

    def _placed(self, heard: Heard, *, was_frozen: bool) -> int | None:
        """Return when it was said, by our clock; None if that cannot be known."""
        if -_AHEAD_NS <= heard.age_ns <= LATE_NS:
            return min(heard.said_ns, heard.heard_ns)
        last, self._strange = self._strange, None if was_frozen else heard
        if last is None or was_frozen:
            return None
        is_together = _APART_NS <= heard.heard_ns - last.heard_ns <= TOGETHER_NS
        is_equal = abs(heard.age_ns - last.age_ns) <= _EQUAL_NS
        return heard.heard_ns - 2 * _EQUAL_NS if is_together and is_equal else None

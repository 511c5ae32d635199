"""Which emergency stops hold and which are released, as every node that obeys them keeps it.

Each stop is known by who said it when: the time at which its message was published, by the clock of
its publisher, and the message's number there. A release covers the stops that its hearer knew of
before it was said (`safety.known_stops`), and no other. So two records can be merged in any
order, as often as they arrive: nodes that hear of each other end with the same one, a stop that
anybody has heard is a stop of all, a late copy of a stop that was released changes nothing, and a
release never undoes a stop that came after it, however late it is heard (an observed-remove set:
Shapiro et al., 2011, "A comprehensive study of convergent and commutative replicated data types").
When in doubt the stop wins.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

MOST_HELD = 8
"""Of a stop that is repeated, the newest messages stand for all."""
MOST_RELEASED = 32
"""A copy of an older one that arrives late is a new stop."""
_MOST = 1 << 62


class Stop(NamedTuple):
    """One stop; all who hear of it give it the same name."""

    said_ns: int
    """Unix time of its message, by the clock of the publisher."""
    number: int = 0
    """Of the message at its publisher; 0: it came by no message."""

    def __str__(self) -> str:
        return f"{self.said_ns}.{self.number}"


@dataclass(frozen=True)
class StopRecord:
    """The stops that hold, and those that were released."""

    held: frozenset[Stop] = frozenset()
    released: Mapping[Stop, int] = field(default_factory=dict)
    """Each with the number of its release: one more than the highest that was known then."""

    @property
    def engaged(self) -> bool:
        """Whether nothing may move."""
        return bool(self.held)

    @property
    def releases(self) -> int:
        """The number of the newest release, 0 if there was none."""
        return max(self.released.values(), default=0)

    def stopped(self, *stops: Stop) -> StopRecord:
        """Return it with these stops; those that were released already change nothing."""
        return self.merged(StopRecord(frozenset(stops)))

    def freed(self, stops: Iterable[Stop] | None = None) -> StopRecord:
        """Return it with these stops released, or with all that is held."""
        number = self.releases + 1
        freed = self.held if stops is None else stops
        return self.merged(StopRecord(released=dict.fromkeys(freed, number)))

    def merged(self, other: StopRecord) -> StopRecord:
        """Return what both know together."""
        numbers = dict(self.released)
        for stop, number in other.released.items():
            numbers[stop] = max(number, numbers.get(stop, 0))
        newest = sorted(numbers.items(), key=lambda one: (one[1], one[0]))[-MOST_RELEASED:]
        held = sorted((self.held | other.held) - numbers.keys())[-MOST_HELD:]
        return StopRecord(frozenset(held), dict(newest))

    # ---------------------------------------------------------------- as text

    def texts(self) -> dict[str, str]:
        """Return it as it is published and saved: `stops` and `released`, separated by blanks."""
        released = sorted(self.released.items(), key=lambda one: (one[1], one[0]))
        return {
            "stops": " ".join(map(str, sorted(self.held))),
            "released": " ".join(f"{number}:{stop}" for stop, number in released),
        }


def read_record(stops: str, released: str) -> StopRecord:
    """Return the record that `StopRecord.texts` was made of; what makes no sense is left out."""
    held = [_stop(word) for word in stops.split()[-MOST_HELD:]]
    numbers: dict[Stop, int] = {}
    for word in released.split()[-MOST_RELEASED:]:
        number, _, name = word.partition(":")
        stop = _stop(name)
        if stop is not None and _whole(number):
            numbers[stop] = int(number)
    known = frozenset(stop for stop in held if stop is not None)
    return StopRecord().merged(StopRecord(known, numbers))


def _stop(word: str) -> Stop | None:
    said_ns, _, number = word.partition(".")
    return Stop(int(said_ns), int(number)) if _whole(said_ns) and _whole(number) else None


def _whole(word: str) -> bool:
    return len(word) < 20 and word.isascii() and word.isdigit() and int(word) < _MOST


# ---------------------------------------------------------------- what may release

_IN_A_ROW = 3
"""So many stops of one publisher, one after the other, are insisting."""
_INTERVALS, _LEAST_S, _LONGEST_S = 2.0, 0.5, 30.0
"""How many of its intervals a publisher has to be silent, and bounds of that."""
_CHAINS = 16


class _Chain(NamedTuple):
    said_ns: int
    length: int
    interval_s: float
    heard_s: float
    is_ended: bool = False
    """Whether a release may have been its next message."""
    is_another: bool = False
    """Whether that has turned out to be a message of another publisher."""


class Insistence:
    """Whether somebody keeps saying stop, against whom a release by another has no effect."""

    def __init__(self) -> None:
        self._chains: dict[int, _Chain] = {}
        """By the number of the newest message of each: the next one follows it."""

    def hear(self, stops: Iterable[Stop], now_s: float) -> None:
        """Take in stops that were heard, copies among them; `now_s` is a monotonic time."""
        for stop in sorted(stops):
            known = self._chains.get(stop.number)
            if known is not None and known.said_ns == stop.said_ns:
                continue
            last = self._chains.pop(stop.number - 1, None) if stop.number > 1 else None
            chain = _Chain(stop.said_ns, 1, 0.0, now_s)
            if last is not None and stop.said_ns > last.said_ns:
                chain = chain._replace(
                    length=last.length + 1,
                    interval_s=(stop.said_ns - last.said_ns) / 1e9,
                    is_another=last.is_another or last.is_ended,
                )
            self._chains[stop.number] = chain
        while len(self._chains) > _CHAINS:
            del self._chains[min(self._chains, key=lambda number: self._chains[number].heard_s)]

    def lasts(self, now_s: float, number: int = 0) -> bool:
        """Return whether it does when a release with this number comes.

        One who releases it by the next message has changed its mind.
        """
        own = self._chains.get(number - 1)
        if own is not None and not own.is_another:
            self._chains[number - 1] = own._replace(is_ended=True)
        return any(chain.length >= _IN_A_ROW and _lasts(chain, now_s) for chain in self._chains.values())


def _lasts(chain: _Chain, now_s: float) -> bool:
    silence_s = min(_INTERVALS * chain.interval_s + _LEAST_S, _LONGEST_S)
    return not chain.is_ended and now_s - chain.heard_s < silence_s

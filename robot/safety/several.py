"""What counts where several publishers speak on an input that only one should: the most careful.

A forgotten mock, or a recording that is played, must not make the robot bolder than the one sensor
or gate that is right. Which message is from whom rclpy does not tell; but each publisher numbers
its messages one by one, so the messages fall into streams. Whose a stream is follows from the
graph: that of the only publisher while there is one, and that of the last whose stream is unknown.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Generic, TypeVar

from robot.safety.distance import Reading

_MOST = 4096
_LOST = 100
"""So many messages of a stream may be missing; after more it counts as another one."""
_STREAMS = 16
_ALONE_S = 1.0
"""A message may arrive a moment before its publisher is in the graph."""

Said = TypeVar("Said")


@dataclass
class _Stream(Generic[Said]):
    number: int
    said: Said
    first_s: float
    last_s: float
    publisher: bytes | None = None
    """Whose it is, None while that is not known."""


class Streams(Generic[Said]):
    """The newest message of each publisher of an input, as far as their numbers tell them apart."""

    def __init__(self) -> None:
        self._streams: list[_Stream[Said]] = []
        self._publishers: dict[bytes, str] = {}

    def hear(self, said: Said, number: int, now_s: float) -> None:
        """Add a message; its number is 0 if the middleware tells none."""
        before = [one for one in self._streams if 0 <= number - one.number - bool(number) <= _LOST]
        stream = max(before, key=lambda one: one.number, default=None)
        if stream is None:
            self._streams.append(_Stream(number, said, now_s, now_s))
            self._streams.sort(key=lambda one: one.last_s)
            del self._streams[:-_STREAMS]
        else:
            stream.number, stream.said, stream.last_s = number, said, now_s

    def forget_but_newest(self) -> None:
        """Forget all but the one that spoke last: only one is there."""
        self._streams = self._streams[-1:] and [max(self._streams, key=lambda one: one.last_s)]

    def fresh(self, now_s: float, stale_after_s: float) -> list[Said]:
        """Return the newest message of each that has not been silent for longer."""
        return [one.said for one in self._streams if now_s - one.last_s <= stale_after_s]

    def silence_s(self, now_s: float, stale_after_s: float) -> float | None:
        """Return for how long one is silent that spoke while another did that still speaks.

        None if there is no such one. A node that was started again in the place of one that died is
        no second one.
        """
        silent = self._silent(now_s, stale_after_s)
        return max((now_s - one.last_s for one in silent), default=None)

    def are(self, publishers: Mapping[bytes, str], now_s: float) -> None:
        """Say which publishers there are: their identifiers and the names of their nodes."""
        self._publishers = dict(publishers)
        if len(publishers) == len(self._streams) == 1:
            (stream,) = self._streams
            if now_s - stream.first_s >= _ALONE_S:
                (stream.publisher,) = publishers

    def too_rare(self, now_s: float, stale_after_s: float) -> tuple[str, ...]:
        """Return who is silent as `silence_s` says; several names if it is one of them."""
        names: set[str] = set()
        for one in self._silent(now_s, stale_after_s):
            known = {each.publisher for each in self._streams if each is not one}
            whose = [one.publisher] if one.publisher in self._publishers else self._publishers
            names.update(self._publishers[gid] for gid in whose if gid and gid not in known)
        return tuple(sorted(names))

    def _silent(self, now_s: float, stale_after_s: float) -> Iterator[_Stream[Said]]:
        fresh = [one for one in self._streams if now_s - one.last_s <= stale_after_s]
        for one in self._streams:
            if now_s - one.last_s > stale_after_s and any(one.last_s >= other.first_s for other in fresh):
                yield one


class LowestReading:
    """The distance that counts: the newest reading; of several publishers, the lowest of the recent ones."""

    def __init__(self, now_s: float) -> None:
        self._distance_m: float | None = None
        self._seen_s = now_s
        self._recent: deque[tuple[float, float]] = deque(maxlen=_MOST)
        self._streams: Streams[float] = Streams()
        self._are_several = False

    def see(self, distance_m: float, now_s: float, *, number: int = 0, publishers: int = 1) -> None:
        """Add a reading, its number at its publisher, and how many publishers there are now."""
        self._distance_m, self._seen_s = distance_m, now_s
        self._recent.append((now_s, distance_m))
        self._streams.hear(distance_m, number, now_s)
        self._are_several = publishers > 1
        if not self._are_several:
            self._streams.forget_but_newest()

    def are(self, publishers: Mapping[bytes, str], now_s: float) -> None:
        """Say which publishers there are: their identifiers and the names of their nodes."""
        self._streams.are(publishers, now_s)

    def too_rare(self, now_s: float, stale_after_s: float) -> tuple[str, ...]:
        """Return who of several has fallen silent while others speak; one of them if more."""
        if not self._are_several or now_s - self._seen_s > stale_after_s:
            return ()
        return self._streams.too_rare(now_s, stale_after_s)

    def reading(self, now_s: float, stale_after_s: float) -> Reading:
        """Return what counts now, and its age.

        Of several: silence if one has fallen silent, no valid reading if that is the newest of one,
        else the lowest within the longest harmless silence.
        """
        age_s = now_s - self._seen_s
        if not self._are_several or age_s > stale_after_s:
            return Reading(self._distance_m, age_s)
        silence_s = self._streams.silence_s(now_s, stale_after_s)
        if silence_s is not None:
            return Reading(None, silence_s)
        newest = self._streams.fresh(now_s, stale_after_s)
        if not all(map(_is_valid, newest)):
            return Reading(math.nan, age_s)
        while self._recent and now_s - self._recent[0][0] > stale_after_s:
            self._recent.popleft()
        valid = [distance_m for _, distance_m in self._recent if _is_valid(distance_m)]
        return Reading(min(valid, default=math.nan), age_s)


class SlowestCommand(Generic[Said]):
    """The command that counts: the newest; of several publishers, the slowest of the recent ones.

    So whoever publishes past the gate makes the robot no faster than the gate allows.
    """

    def __init__(self) -> None:
        self._recent: deque[tuple[float, float, Said]] = deque(maxlen=_MOST)
        self._streams: Streams[Said] = Streams()

    def choose(
        self, command: Said, speed: float, now_s: float, *, within_s: float, number: int = 0, publishers: int = 1
    ) -> Said | None:
        """Return what to do after this command, with its speed and its number; None: stop.

        Several stop the robot if one of them drives the other way, or if one falls silent.
        """
        self._recent.append((now_s, speed, command))
        self._streams.hear(command, number, now_s)
        if publishers <= 1:
            self._streams.forget_but_newest()
            return command
        while now_s - self._recent[0][0] > within_s:
            self._recent.popleft()
        speeds = [speed for _, speed, _ in self._recent]
        if min(speeds) < 0.0 < max(speeds):
            return None
        if self._streams.silence_s(now_s, within_s) is not None:
            return None
        return min(reversed(self._recent), key=lambda one: abs(one[1]))[2]


def _is_valid(distance_m: float) -> bool:
    return distance_m == -math.inf or distance_m >= 0.0

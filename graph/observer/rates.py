"""The rate of a topic, its jitter and latency over the last seconds, from messages polled a few times a second."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING

from graph.messages.stamps import FARTHEST_S

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


WINDOW_S = 4.0
"""Long enough that the jitter of two stamps is below 0.5 % of it, short enough to follow."""
FEWEST = 3
"""The fewest figures for a meaningful spread."""
KEPT = 10
"""Figures that are kept whatever their age, so that a slow topic has a spread, too."""


@dataclass(frozen=True)
class Arrival:
    """What the middleware reports about one message."""

    stamp_s: float
    """When it came in, unix time."""
    size_bytes: int
    sequence: int | None = None
    """Its sequence number at the publisher, if the middleware counts them."""
    delay_s: float | None = None
    """Between the stamp in its header and its arrival, if it has one."""
    is_of_past: bool = False
    """Whether when it came says nothing of how often they are sent: a latched one that was sent
    before Deck subscribed, or the first of its publisher."""


@dataclass(frozen=True)
class _Batch:
    """Figures that came together: how many, their sum, and the sum of their squares."""

    stamp_s: float
    count: int
    total: float
    squares: float


class Spread:
    """Mean and standard deviation of the figures of the last `WINDOW_S`, in seconds."""

    def __init__(self) -> None:
        self._batches: deque[_Batch] = deque()
        self._count = 0
        self._about = 0.0

    def add(self, stamp_s: float, figures_s: Sequence[float]) -> None:
        """Add the figures found by `stamp_s`, and drop those that are too old."""
        if not figures_s:
            return
        if not self._batches:
            # Sums of differences from a value near the mean do not lose precision.
            self._about = figures_s[0]
        off = [figure - self._about for figure in figures_s]
        squares = math.fsum(figure * figure for figure in off)
        self._batches.append(_Batch(stamp_s, len(off), math.fsum(off), squares))
        self._count += len(off)
        while self._is_too_old(self._batches[0], stamp_s):
            self._count -= self._batches.popleft().count

    def clear(self) -> None:
        """Forget everything: what comes next is unrelated."""
        self._batches.clear()
        self._count = 0

    @property
    def mean_s(self) -> float | None:
        """Mean; None without a figure."""
        if not self._count:
            return None
        return self._about + sum(batch.total for batch in self._batches) / self._count

    @property
    def deviation_s(self) -> float | None:
        """Standard deviation; None while there are too few."""
        if self._count < FEWEST:
            return None
        mean = sum(batch.total for batch in self._batches) / self._count
        squares = sum(batch.squares for batch in self._batches) / self._count
        return math.sqrt(max(0.0, squares - mean * mean))

    def _is_too_old(self, batch: _Batch, now_s: float) -> bool:
        return now_s - batch.stamp_s > WINDOW_S and self._count - batch.count >= KEPT


class Intervals:
    """The time between consecutive messages."""

    def __init__(self) -> None:
        self._spread = Spread()
        self._newest: Arrival | None = None

    def add(self, batch: Sequence[Arrival], *, overflowed: bool, numbered: bool) -> None:
        """Add a batch in order of arrival.

        `overflowed` says that messages may be missing before it, `numbered` that the sequence
        numbers come from one writer, so that they show whether any is missing.
        """
        found_s = []
        before, follows = self._newest, not overflowed
        for arrival in batch:
            if before is not None and _is_next(before, arrival, follows, numbered=numbered):
                found_s.append(arrival.stamp_s - before.stamp_s)
            before, follows = arrival, True
        self._newest = before
        self._spread.add(batch[-1].stamp_s, found_s)

    def clear(self) -> None:
        """Forget everything, including the last message."""
        self._spread.clear()
        self._newest = None

    @property
    def deviation_s(self) -> float | None:
        """Standard deviation; None while there are too few."""
        return self._spread.deviation_s


def _is_next(before: Arrival, arrival: Arrival, follows: bool, *, numbered: bool) -> bool:
    """Return whether no message is missing between the two; `follows` if they have no numbers."""
    if arrival.stamp_s < before.stamp_s:
        return False
    if numbered and before.sequence is not None and arrival.sequence is not None:
        return arrival.sequence == before.sequence + 1
    return follows


FEW = 3
"""Points that are kept whatever their age, so that a slow topic has a rate, too."""
QUIET_S = 3.0
QUIET_PERIODS = 3.0
TURNS = 3
"""So many steps back in the sequence numbers within `WINDOW_S` show that several publishers send:
a publisher that was started again makes one."""
MOST_KNOWN = 256
"""Latched messages that are recognised when they are delivered again."""
STEADY = 10
"""The fewest messages that can be called regular, and below, the greatest spread of the time
between them, in periods."""
STEADY_SPREAD = 0.5


@dataclass(frozen=True)
class _Point:
    """How many messages had come by the stamp of a batch's newest message."""

    stamp_s: float
    messages: int
    bytes: float


class RateMeter:
    """Rate, bandwidth, age, jitter and latency of one topic, from the stamps of the middleware.

    A batch is the content of the queue at one poll. Only its newest stamp is kept: between two such
    stamps the number of messages is exact, whenever the polls took place.
    """

    def __init__(self) -> None:
        self.count = 0
        self.mean_size_bytes = 0.0
        self.lost: int | None = None
        """Messages that the middleware knows to be lost; None while it reports nothing."""
        self._timed = 0
        """Messages that came when they were sent."""
        self._bytes = 0.0
        self._known: deque[tuple[int, int | None]] = deque(maxlen=MOST_KNOWN)
        self._points: deque[_Point] = deque()
        self._sequence: int | None = None
        self._intervals = Intervals()
        self._delays = Spread()
        self._turns: deque[float] = deque(maxlen=TURNS)
        """When the last steps back in the sequence numbers came."""
        self._clock_off_s: float | None = None

    def add(
        self, batch: list[Arrival], *, overflowed: bool = False, one_publisher: bool = True, lost: int = 0
    ) -> None:
        """Add a batch in order of arrival.

        `overflowed` says that the queue was full. With one publisher, a gap in the sequence before
        the batch is then our own doing: its messages did arrive, except those `lost` on the way.
        """
        self._add_past([arrival for arrival in batch if arrival.is_of_past])
        batch = [arrival for arrival in batch if not arrival.is_of_past]
        if not batch:
            return
        skipped = self._skipped(batch, lost) if overflowed and one_publisher else 0
        size = sum(arrival.size_bytes for arrival in batch)
        self.count += len(batch) + skipped
        self._timed += len(batch) + skipped
        self._bytes += size * (1 + skipped / len(batch))
        self.mean_size_bytes = size / len(batch)
        self._note_turns(batch)
        self._sequence = batch[-1].sequence
        stamp_s = batch[-1].stamp_s
        if self._is_another_story(stamp_s):
            self._points.clear()
            self._intervals.clear()
            self._delays.clear()
        self._intervals.add(batch, overflowed=overflowed, numbered=one_publisher)
        self._add_delays(stamp_s, [a.delay_s for a in batch if a.delay_s is not None])
        self._points.append(_Point(stamp_s, self._timed, self._bytes))
        while len(self._points) > FEW and stamp_s - self._points[0].stamp_s > WINDOW_S:
            self._points.popleft()

    def is_again(self, sent_ns: int, number: int | None) -> bool:
        """Return whether a latched message was here before, by when it was sent and its number.

        It comes again to each new subscription of Deck's.
        """
        key = (sent_ns, number)
        if key in self._known:
            return True
        self._known.append(key)
        return False

    def _add_past(self, batch: list[Arrival]) -> None:
        if not batch:
            return
        self.count += len(batch)
        self.mean_size_bytes = sum(arrival.size_bytes for arrival in batch) / len(batch)
        self._sequence = batch[-1].sequence
        if not self._points:
            # It has an age.
            self._points.append(_Point(batch[-1].stamp_s, self._timed, self._bytes))

    def _add_delays(self, stamp_s: float, delays_s: list[float]) -> None:
        """Keep those of this clock, and how far off the newest one is if it is of another."""
        self._delays.add(stamp_s, [each for each in delays_s if abs(each) <= FARTHEST_S])
        if delays_s:
            newest_s = delays_s[-1]
            self._clock_off_s = newest_s if abs(newest_s) > FARTHEST_S else None

    def _note_turns(self, batch: list[Arrival]) -> None:
        before = self._sequence
        for arrival in batch:
            if arrival.sequence is not None and before is not None and arrival.sequence <= before:
                self._turns.append(arrival.stamp_s)
            before = arrival.sequence

    def _is_another_story(self, stamp_s: float) -> bool:
        """Return whether the clock was set back, or a topic with a known rate had gone quiet."""
        if not self._points:
            return False
        return stamp_s < self._points[-1].stamp_s or (len(self._points) > 1 and self.is_quiet(stamp_s))

    def _skipped(self, batch: list[Arrival], lost: int) -> int:
        first, last = batch[0].sequence, batch[-1].sequence
        if self._sequence is None or first is None or last is None:
            return 0
        if first <= self._sequence or last <= self._sequence:
            return 0
        missing = last - self._sequence - len(batch)
        return max(0, min(first - self._sequence - 1, missing - lost))

    def hz(self, now_s: float) -> float | None:
        """Messages per second; 0 when it has gone quiet, None before the second message."""
        return self._rate(now_s, lambda point: point.messages)

    def bytes_per_s(self, now_s: float) -> float | None:
        """Bytes per second, by the same rule as `hz`."""
        return self._rate(now_s, lambda point: point.bytes)

    def age_s(self, now_s: float) -> float | None:
        """Seconds since the newest message came, None if none has."""
        return max(0.0, now_s - self._points[-1].stamp_s) if self._points else None

    def jitter_s(self, now_s: float) -> float | None:
        """Standard deviation of the time between messages; None while quiet or too few came."""
        return None if self.is_quiet(now_s) else self._intervals.deviation_s

    def latency_s(self, now_s: float) -> float | None:
        """Mean of arrival minus stamp; None while quiet, or without stamps from this clock."""
        return None if self.is_quiet(now_s) else self._delays.mean_s

    def clock_off_s(self, now_s: float) -> float | None:
        """Arrival minus stamp of the newest message if it is of another clock; None while quiet."""
        return None if self.is_quiet(now_s) else self._clock_off_s

    def several_send(self, now_s: float) -> bool:
        """Return whether the messages of the last seconds have come from several publishers."""
        return len(self._turns) == TURNS and now_s - self._turns[0] <= WINDOW_S

    def steady_hz(self, now_s: float) -> float | None:
        """The rate at which messages came regularly until they stopped; None while they come."""
        spread_s = self._intervals.deviation_s
        if self.count < STEADY or spread_s is None or not self.is_quiet(now_s):
            return None
        hz = self._latest_rate(lambda point: point.messages)
        return hz if hz and spread_s <= STEADY_SPREAD / hz else None

    def is_quiet(self, now_s: float) -> bool:
        """Return whether nothing has come for longer than usual for this topic."""
        age_s = self.age_s(now_s)
        return age_s is not None and age_s > self._patience_s()

    def _rate(self, now_s: float, of: Callable[[_Point], float]) -> float | None:
        if len(self._points) < 2:
            return None
        return 0.0 if self.is_quiet(now_s) else self._latest_rate(of)

    def _latest_rate(self, of: Callable[[_Point], float]) -> float | None:
        """Return the rate while messages last came."""
        if len(self._points) < 2:
            return None
        first, last = self._points[0], self._points[-1]
        span_s = last.stamp_s - first.stamp_s
        return (of(last) - of(first)) / span_s if span_s > 0 else None

    def _patience_s(self) -> float:
        if len(self._points) < 2:
            return QUIET_S
        first, last = self._points[0], self._points[-1]
        period_s = (last.stamp_s - first.stamp_s) / (last.messages - first.messages)
        return max(QUIET_S, QUIET_PERIODS * period_s)

"""Jitter and latency of messages over the last seconds."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

WINDOW_S = 4.0
"""As long as the window of the rate."""
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

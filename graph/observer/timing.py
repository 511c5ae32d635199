"""Jitter and latency of messages over the last seconds."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

WINDOW_S = 4.0
"""As long as the rate's."""
FEWEST = 3
"""Figures without which a spread says nothing."""
KEPT = 10
"""Figures that are kept whatever their age, so that a slow topic has a spread too."""


@dataclass(frozen=True)
class Arrival:
    """What the middleware reports about one message."""

    stamp_s: float
    """When it came in, unix time."""
    size_bytes: int
    sequence: int | None = None
    """Its number at the publisher, where the middleware counts them."""
    delay_s: float | None = None
    """Between the stamp in its header and its arrival, where it has one."""


@dataclass(frozen=True)
class _Batch:
    """Figures that came together, as sums: how many, their sum and that of their squares."""

    stamp_s: float
    count: int
    total: float
    squares: float


class Spread:
    """Mean and standard deviation of figures in seconds, those of the last `WINDOW_S`."""

    def __init__(self) -> None:
        self._batches: deque[_Batch] = deque()
        self._count = 0
        self._about = 0.0

    def add(self, stamp_s: float, figures_s: Sequence[float]) -> None:
        """Take what was found by `stamp_s`, and let go of what is too old."""
        if not figures_s:
            return
        if not self._batches:
            # Sums of what is left of a value near the mean keep their digits.
            self._about = figures_s[0]
        off = [figure - self._about for figure in figures_s]
        squares = math.fsum(figure * figure for figure in off)
        self._batches.append(_Batch(stamp_s, len(off), math.fsum(off), squares))
        self._count += len(off)
        while self._is_too_old(self._batches[0], stamp_s):
            self._count -= self._batches.popleft().count

    def clear(self) -> None:
        """Forget all: what comes next is another story."""
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
    """The time between messages that came one after the other."""

    def __init__(self) -> None:
        self._spread = Spread()
        self._newest: Arrival | None = None

    def add(self, batch: Sequence[Arrival], *, overflowed: bool, numbered: bool) -> None:
        """Take a batch in order of arrival.

        `overflowed` says that messages may be missing before it, `numbered` that the sequence
        numbers are of one writer, so that they tell whether any is.
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
        """Forget all, the last message too."""
        self._spread.clear()
        self._newest = None

    @property
    def deviation_s(self) -> float | None:
        """Standard deviation; None while there are too few."""
        return self._spread.deviation_s


def _is_next(before: Arrival, arrival: Arrival, follows: bool, *, numbered: bool) -> bool:
    """Tell whether no message is missing between the two; `follows` where no number tells."""
    if arrival.stamp_s < before.stamp_s:
        return False
    if numbered and before.sequence is not None and arrival.sequence is not None:
        return arrival.sequence == before.sequence + 1
    return follows

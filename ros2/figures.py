"""Figures over the last so many messages, in the form of `hz`, `bw` and `delay`."""

from __future__ import annotations

from collections import deque
from statistics import fmean, pstdev


class Window:
    """The last so many values, in seconds."""

    def __init__(self, longest: int) -> None:
        self.values: deque[float] = deque(maxlen=longest)

    def add(self, value: float) -> None:
        self.values.append(value)

    @property
    def mean(self) -> float:
        return fmean(self.values)

    @property
    def spread(self) -> str:
        """The least and the greatest, standard deviation and number."""
        values = self.values
        return f"min: {min(values):.3f}s max: {max(values):.3f}s std dev: {pstdev(values):.5f}s window: {len(values)}"

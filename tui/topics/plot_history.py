"""The values of a plotted field over the last minutes, in a fixed amount of memory."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, SupportsFloat, TypeAlias

import numpy as np
from numpy.typing import NDArray

from graph.data import Sample, Value
from text.plain import plain

Numbers: TypeAlias = NDArray[np.float64]

SLOT_S = 0.025
"""Finer than a dot of the shortest window on the widest terminal."""
SLOTS = 12_288
"""A little over five minutes: a third of a megabyte for each field, whatever its rate."""
QUIET_S = 3.0
QUIET_PERIODS = 3.0
"""After this many periods without a message the line is broken, as with the rates."""


class HistoryDots(NamedTuple):
    """A history as seen in a window, in dots from left to right; nan if there was no number."""

    low: Numbers
    high: Numbers
    last: Numbers
    broken: NDArray[np.bool_]
    """Whether the line is broken between this dot and the previous one with a number."""


class History:
    """The lowest, highest and last number of each time slot, and where the line is broken."""

    def __init__(self) -> None:
        self._begin()

    def _begin(self) -> None:
        self._numbers = np.full((3, SLOTS), np.nan)
        """Lowest, highest and last of each slot."""
        self._broken = np.zeros(SLOTS, np.bool_)
        self._newest = -1
        """Number of the newest slot, counted from the epoch; -1 before the first message."""
        self._time_s = 0.0
        self._period_s = math.inf
        self._gap = False
        self.last: float | None = None
        """The newest number, finite or not; None before the first message."""

    def add(self, time_s: float, number: float | None) -> None:
        """Add a number received at this Unix time; None if the message had none.

        If time goes back, the clock was set back, and the history starts over.
        """
        slot = int(time_s / SLOT_S)
        if slot < self._newest - 1:
            self._begin()
        slot = max(slot, self._newest)
        self._go_to(slot)
        self._note_pause(time_s)
        self.last = number
        if number is None or not math.isfinite(number):
            self._gap = True
            return
        at = slot % SLOTS
        self._broken[at] |= self._gap
        self._gap = False
        low, high, _last = self._numbers[:, at]
        self._numbers[:, at] = np.fmin(low, number), np.fmax(high, number), number

    def range(self, end_s: float, window_s: float) -> tuple[float, float] | None:
        _first, (low, high, _last), _broken = self._window(end_s, window_s)
        seen = np.isfinite(low)
        return (float(low[seen].min()), float(high[seen].max())) if seen.any() else None

    def columns(self, end_s: float, window_s: float, count: int) -> HistoryDots:
        """The window that ends at this time, as `count` dots."""
        first, (low, high, last), broken = self._window(end_s, window_s)
        width_s = window_s / count
        # Counted from the epoch: a dot keeps its slots while the window moves by whole dots.
        starts = [round((end_s - (count - n) * width_s) / SLOT_S) for n in range(count)]
        edges = np.clip(np.array([*starts, first + len(low)]) - first, 0, len(low))
        out = HistoryDots(
            np.full(count, np.nan), np.full(count, np.nan), np.full(count, np.nan),
            np.zeros(count, np.bool_),
        )  # fmt: skip
        seen = np.flatnonzero(np.isfinite(low))
        if not seen.size:
            return out
        dots = np.clip(np.searchsorted(edges, seen, "right") - 1, 0, count - 1)
        np.fmin.at(out.low, dots, low[seen])
        np.fmax.at(out.high, dots, high[seen])
        out.last[dots] = last[seen]
        np.logical_or.at(out.broken, dots, broken[seen])
        return out

    def _window(self, end_s: float, window_s: float) -> tuple[int, Numbers, NDArray[np.bool_]]:
        """The number of the first slot, and all slots of it; blank if they are too old or in the future."""
        after = int(end_s / SLOT_S) + 1
        slots = np.arange(after - min(SLOTS, int(window_s / SLOT_S)), after)
        known = (slots <= self._newest) & (slots > self._newest - SLOTS)
        numbers, broken = self._numbers[:, slots % SLOTS], self._broken[slots % SLOTS]
        return int(slots[0]), np.where(known, numbers, np.nan), known & broken

    def _go_to(self, slot: int) -> None:
        if self._newest < 0:
            self._newest = slot
        steps = min(SLOTS, slot - self._newest)
        if steps > 0:
            fresh = np.arange(slot - steps + 1, slot + 1) % SLOTS
            self._numbers[:, fresh] = np.nan
            self._broken[fresh] = False
            self._newest = slot

    def _note_pause(self, time_s: float) -> None:
        if self._time_s:
            passed_s = time_s - self._time_s
            if passed_s > max(QUIET_S, QUIET_PERIODS * self._period_s) and math.isfinite(self._period_s):
                self._gap = True
            else:
                self._period_s = passed_s
        self._time_s = time_s


LONGEST = 200


class PlotField(NamedTuple):
    """One number in the messages of a topic."""

    topic: str
    path: tuple[str | int, ...]
    """Field names and indexes: `("ranges", 3)`."""

    @property
    def name(self) -> str:
        """The path as written by users: `drive.speed`, `ranges[3]`."""
        parts = [f"[{step}]" if isinstance(step, int) else f".{step}" for step in self.path]
        return plain("".join(parts).removeprefix("."), LONGEST)

    def number(self, message: Mapping[str, Value]) -> float | None:
        """The field's number, including nan and infinities; None if there is none."""
        value: Any = message
        for step in self.path:
            if isinstance(value, bytes):
                return None
            try:
                value = value[step]
            except (LookupError, TypeError):
                return None
        return as_number(value)


@dataclass
class Series:
    """One field with its letter in the plot, its look and its history."""

    field: PlotField
    letter: str
    look: str
    history: History
    is_number: bool = True
    """Whether the newest message had a number in this field."""

    def take(self, sample: Sample) -> None:
        number = self.field.number(sample.value)
        self.is_number = number is not None
        self.history.add(sample.received_s - sample.age_s, number)


def as_number(value: object) -> float | None:
    if not isinstance(value, SupportsFloat) or hasattr(value, "__len__"):
        return None
    try:
        return float(value)
    except OverflowError:
        return math.inf

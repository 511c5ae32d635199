"""Axes with round numbers, which do not change with every message."""

from __future__ import annotations

import math
from dataclasses import dataclass

STEPS = (1.0, 2.0, 5.0, 10.0)
TOO_WIDE = 3.0
"""If the range is narrower than the axis by this factor, the axis is replaced."""
LEAST_SPAN = 1e-9
NEAR = 1e-6
FINER = 4
"""Number of steps of the ends in one tick, which limits the blank space above and below."""
HUGE = 1e15
TINIEST = 1e-290
"""Smaller numbers cannot be divided any further."""
PLACES_MOST = 6


@dataclass(frozen=True)
class ValueAxis:
    """From `low` to `high`, both round, with a tick at each multiple of `step` between them."""

    low: float
    high: float
    step: float

    @property
    def ticks(self) -> list[float]:
        first = math.ceil(self.low / self.step - NEAR)
        last = math.floor(self.high / self.step + NEAR)
        return [self.step * number for number in range(first, last + 1)]

    def label(self, value: float) -> str:
        """Return a tick with the decimals of its step, or with an exponent if that is long."""
        if abs(value) < self.step / 1e3:
            return "0"
        widest = max(abs(self.low), abs(self.high))
        if widest >= 1e6 or self.step < 10**-PLACES_MOST:
            places = max(0, math.floor(math.log10(abs(value))) - math.floor(math.log10(self.step)))
            return f"{value:.{min(places, PLACES_MOST)}e}".replace("e+0", "e").replace("e-0", "e-")
        return f"{value:.{decimals(self.step)}f}"


def decimals(step: float) -> int:
    """Return the number of decimals for a number with this step."""
    return max(0, -math.floor(math.log10(step) + 1e-9))


def round_step(span: float, ticks: int) -> float:
    """Return the smallest step (1, 2 or 5 times a power of ten) that covers the span in `ticks`."""
    least = span / max(1, ticks)
    power = 10.0 ** math.floor(math.log10(least))
    return next(step * power for step in STEPS if step * power >= least * (1 - 1e-9))


def axis_for(low: float, high: float, ticks: int) -> ValueAxis:
    """Return an axis with about this many ticks that contains everything from `low` to `high`."""
    low, high = max(-HUGE, min(low, HUGE)), max(-HUGE, min(high, HUGE))
    span = high - low
    if span <= LEAST_SPAN * max(1.0, abs(low), abs(high)):
        # A constant value is in the middle, with an axis of its own order of magnitude.
        half = 0.5 * 10.0 ** math.floor(math.log10(abs(low))) if abs(low) > TINIEST else 0.5
        low, high = low - half, high + half
        span = high - low
    fine = round_step(span, FINER * ticks)
    first, last = math.floor(low / fine + NEAR), math.ceil(high / fine - NEAR)
    low, high = first * fine, max(last, first + 1) * fine
    return ValueAxis(low, high, round_step(high - low, ticks))


def steadied(before: ValueAxis | None, low: float, high: float, ticks: int) -> ValueAxis:
    """Keep the axis while it suits, else make a new one: it grows at once and shrinks late."""
    if before is not None and before.low <= low and high <= before.high:
        span = max(high - low, LEAST_SPAN * max(1.0, abs(low), abs(high)))
        near = axis_for(low, high, ticks)
        if near.step >= before.step / TOO_WIDE and (before.high - before.low) < TOO_WIDE * max(
            span, near.high - near.low
        ):
            return before
    return axis_for(low, high, ticks)

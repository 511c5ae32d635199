"""Times and counts of a topic as short texts, for the table, the head and the endpoints alike."""

from __future__ import annotations

from text.figures import figure, whole
from text.i18n import _

UNKNOWN = "–"
WHOLE_FROM = 100
MILLI = 1e-3
MICRO = 1e-6


def seconds_text(seconds: float | None) -> str:
    """A short time with two or three digits and a unit: `12 µs`, `1.2 ms`, `350 ms`, `2.5 s`."""
    if seconds is None:
        return UNKNOWN
    size = abs(seconds)
    if size >= MILLI * 999.5:
        return _("{n} s").format(n=_figures(seconds))
    if size >= MICRO * 99.95:
        return _("{n} ms").format(n=_figures(seconds / MILLI))
    return _("{n} µs").format(n=whole(seconds / MICRO))


def count_text(count: int | None) -> str:
    if count is None:
        return UNKNOWN
    if count < 100_000:
        return str(count)
    return f"{count / 1000:.0f}k" if count < 10_000_000 else f"{whole(count / 1_000_000)}M"


def _figures(value: float) -> str:
    return figure(value, 0 if abs(value) >= WHOLE_FROM - 0.05 else 1)

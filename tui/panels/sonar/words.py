"""The meaning of a distance: free, close, stop, or no reading at all (REP-117)."""

from __future__ import annotations

import math
from enum import Enum
from typing import NamedTuple

from text.figures import figure
from text.i18n import N_, _

FREE_FROM_M = 1.0
"""ai_brain drives ahead from this distance on."""
RANGE_M = 3.0
"""The distance at the right end of the bar."""


class Bounds(NamedTuple):
    """Which distances count as near, in metres; those of the course until the gate reports any."""

    stop_below_m: float = 0.5
    """safety_stop holds the wheels below this distance."""
    free_from_m: float = FREE_FROM_M
    """From this distance on nothing slows the robot down."""


COURSE = Bounds()


class Zone(Enum):
    """The word and the look for a distance."""

    FREE = (N_("FREE"), "good")
    CLOSE = (N_("CLOSE"), "warn")
    STOP = (N_("STOP"), "stop")
    BLIND = (N_("BLIND"), "stop")

    @property
    def word(self) -> str:
        return _(self.value[0])

    @property
    def look(self) -> str:
        return self.value[1]


def zone_of(metres: float, bounds: Bounds = COURSE) -> Zone:
    """The zone of a distance in metres; +inf is free, -inf too close, nan blind."""
    if math.isnan(metres):
        return Zone.BLIND
    if metres < bounds.stop_below_m:
        return Zone.STOP
    return Zone.CLOSE if metres < bounds.free_from_m else Zone.FREE


def number(metres: float) -> str:
    """The distance with two decimals, or a sign if it is not a number."""
    if math.isnan(metres):
        return "---"
    if math.isinf(metres):
        return "∞" if metres > 0 else "0"
    return figure(metres)


def remark(metres: float) -> str:
    """The meaning of a value that is not a distance; empty for a distance."""
    if math.isnan(metres):
        return _("no valid reading")
    if math.isinf(metres):
        return _("nothing in range") if metres > 0 else _("too close to measure")
    return _("impossible: below zero") if metres < 0 else ""

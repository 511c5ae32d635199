"""Which distances count as near, as reported by the safety node that is running."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from robot.safety.gate_report import Gate, gate_in
from robot.topics import SAFETY_STATE
from tui.panels.panel import newest, row_of
from tui.panels.sonar.words import COURSE, FREE_FROM_M, Bounds

if TYPE_CHECKING:
    from graph.data import GraphUpdate


def bounds_of(update: GraphUpdate, before: Bounds) -> Bounds:
    """Return the last bounds that the safety node reported; they were `before`.

    Those of the course if none are reported: with a learner's own node, or with none.
    """
    row = row_of(update, SAFETY_STATE)
    if row is None or not row.publishers:
        return COURSE
    sample = newest(update, SAFETY_STATE)
    gate = None if sample is None else gate_in(sample.value)
    return before if gate is None else _told(gate)


def _told(gate: Gate) -> Bounds:
    stop_below_m, slow_m = gate.critical_m, gate.slow_m
    if stop_below_m is None or not 0.0 < stop_below_m < math.inf:
        return COURSE
    if slow_m is not None and stop_below_m < slow_m < math.inf:
        # The speed limit falls to zero towards that distance, so at it the robot stands.
        return Bounds(math.nextafter(stop_below_m, math.inf), slow_m)
    return Bounds(stop_below_m, max(stop_below_m, FREE_FROM_M))

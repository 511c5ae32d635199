"""The joints of the pan and tilt head: pulses for angles, and the duration of a turn."""

from __future__ import annotations

import math
from dataclasses import dataclass

from robot.limits import HEAD_ANGLE, Limits
from robot.wire.lsc16 import CENTRE_US, PULSE, TIME

_LEAST_MS = 20
"""Minimum time between two pulses to a servo."""


@dataclass(frozen=True)
class HeadJoint:
    """One servo of the head. Angles are those of the head, degrees, + is left and up."""

    servo: int
    """Its number at the controller, 1 to 16."""
    limits: Limits = HEAD_ANGLE
    """How far the head may turn."""
    trim_deg: float = 0.0
    """Trim: the servo's angle at which the head looks straight ahead."""
    reversed: bool = False
    """Whether a longer pulse turns the head right or down."""
    turn_deg: float = 180.0
    """How far the servo turns from the shortest pulse to the longest."""

    @property
    def reach(self) -> Limits:
        """The angles that are allowed and within the servo's reach, including its trim."""
        ends = (self._way * (side * self.turn_deg / 2 - self.trim_deg) for side in (-1, 1))
        low, high = sorted(ends)
        return Limits(max(low, self.limits.low), min(high, self.limits.high), "deg")

    def pulse_us(self, angle_deg: float) -> int:
        """Return the pulse for an angle; raises ValueError for one outside `reach`."""
        if angle_deg not in self.reach:
            raise ValueError(f"{angle_deg} is not within {self.reach.low} .. {self.reach.high}")
        servo_deg = self._way * angle_deg + self.trim_deg
        return round(CENTRE_US + servo_deg * self._us_per_deg)

    def way_deg(self, start_us: int | None, goal_deg: float) -> float:
        """Return the way to an angle; the longest possible if the starting pulse is unknown."""
        if start_us is None:
            return max(goal_deg - self.reach.low, self.reach.high - goal_deg)
        return abs(self.pulse_us(goal_deg) - start_us) / self._us_per_deg

    @property
    def _way(self) -> int:
        return -1 if self.reversed else 1

    @property
    def _us_per_deg(self) -> float:
        return (PULSE.high - PULSE.low) / self.turn_deg


def turn_ms(way_deg: float, speed_deg_s: float) -> int:
    """Return the duration of a turn at a speed, within what the controller accepts."""
    return min(int(TIME.high), max(_LEAST_MS, math.ceil(1000 * way_deg / speed_deg_s)))

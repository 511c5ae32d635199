"""When the robot may move: what a distance means, and what becomes of a command.

When in doubt it stops: a sensor that is silent or broken counts as an obstacle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from robot.words import STOP, DriveSetpoint


class Sight(str, Enum):
    """What a distance sensor tells about the way ahead of it."""

    FREE = "free"
    CLOSE = "close"
    """An obstacle nearer than the critical distance."""
    INVALID = "invalid"
    """The newest reading is no distance."""
    SILENT = "silent"
    """No reading yet, or none for too long."""


class Verdict(str, Enum):
    """Where the robot may not go."""

    FREE = "free"
    BLOCKED_FORWARD = "blocked_forward"
    BLOCKED_BACKWARD = "blocked_backward"
    BLOCKED = "blocked"
    """Neither forward nor backward."""
    EMERGENCY_STOP = "emergency_stop"


@dataclass(frozen=True)
class Reading:
    """The newest word of a distance sensor."""

    distance_m: float | None = None
    """By REP-117: +inf nothing in range, -inf too close to measure, nan no valid reading; None if
    there was none at all."""
    age_s: float = 0.0


def look(reading: Reading, critical_m: float, stale_after_s: float) -> Sight:
    """Judge a reading; `stale_after_s` is the longest silence that is no danger."""
    if reading.distance_m is None or not reading.age_s <= stale_after_s:
        return Sight.SILENT
    if math.isnan(reading.distance_m) or -math.inf < reading.distance_m < 0.0:
        return Sight.INVALID
    return Sight.CLOSE if reading.distance_m < critical_m else Sight.FREE


def where(front: Sight, rear: Sight | None, emergency: bool) -> Verdict:
    """Where the robot may not go now. `rear` is None for a robot without a sensor there."""
    if emergency:
        return Verdict.EMERGENCY_STOP
    forward_bad, backward_bad = front != Sight.FREE, rear not in (None, Sight.FREE)
    if forward_bad and backward_bad:
        return Verdict.BLOCKED
    if forward_bad:
        return Verdict.BLOCKED_FORWARD
    return Verdict.BLOCKED_BACKWARD if backward_bad else Verdict.FREE


def gate(command: DriveSetpoint, verdict: Verdict) -> DriveSetpoint:
    """What of a command may reach the motors: all of it, or a stop."""
    if not (math.isfinite(command.speed_m_s) and math.isfinite(command.steering_rad)):
        return STOP
    if verdict not in (Verdict.FREE, Verdict.BLOCKED_FORWARD, Verdict.BLOCKED_BACKWARD):
        return STOP
    forbidden = (verdict == Verdict.BLOCKED_FORWARD and command.speed_m_s > 0) or (
        verdict == Verdict.BLOCKED_BACKWARD and command.speed_m_s < 0
    )
    # The wheels may still be turned: a way out has to be steered to.
    return DriveSetpoint(0.0, command.steering_rad) if forbidden else command

"""When the robot may move: what a distance means, and what becomes of a command.

When in doubt it stops: a sensor that is silent or broken counts as an obstacle. Between the slow
and the critical distance a command is slowed in proportion, so that the robot comes to its stop
gently; the steering is left as it is.
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
    STARTING = "starting"
    """The gate has just come and may not have heard of an emergency stop yet."""


_CLOSED = (Verdict.BLOCKED, Verdict.EMERGENCY_STOP, Verdict.STARTING)


@dataclass(frozen=True)
class Reading:
    """The newest word of a distance sensor."""

    distance_m: float | None = None
    """By REP-117: +inf nothing in range, -inf too close to measure, nan no valid reading; None if
    there was none at all."""
    age_s: float = 0.0


@dataclass(frozen=True)
class SafetyZone:
    """How near is near, and how long is too long."""

    critical_m: float = 0.5
    """Nearer than this nothing moves that way."""
    slow_m: float = 0.0
    """Nearer than this it is slowed; not above `critical_m`: no slowing."""
    stale_after_s: float = 2.5
    """The longest silence that is no danger."""


@dataclass(frozen=True)
class Shares:
    """The share of the requested speed that is allowed, 0 to 1."""

    forward: float = 1.0
    backward: float = 1.0

    def towards(self, speed_m_s: float) -> float:
        """The share for this speed; of a robot that stands, that of going forward."""
        return self.backward if speed_m_s < 0 else self.forward


def look(reading: Reading, critical_m: float, stale_after_s: float) -> Sight:
    """Judge a reading; `stale_after_s` is the longest silence that is no danger."""
    if reading.distance_m is None or not reading.age_s <= stale_after_s:
        return Sight.SILENT
    if math.isnan(reading.distance_m) or -math.inf < reading.distance_m < 0.0:
        return Sight.INVALID
    return Sight.CLOSE if reading.distance_m < critical_m else Sight.FREE


def share(reading: Reading, zone: SafetyZone) -> float:
    """How much of a speed towards that sensor's side is allowed, 0 to 1.

    0 wherever `look` sees no free way, 1 from the slow distance on, a straight line between 0 at
    the critical distance and that.
    """
    if look(reading, zone.critical_m, zone.stale_after_s) != Sight.FREE:
        return 0.0
    distance_m = reading.distance_m
    if distance_m is None or distance_m >= zone.slow_m:
        return 1.0
    return (distance_m - zone.critical_m) / (zone.slow_m - zone.critical_m)


def where(front: Sight, rear: Sight | None, emergency: bool, *, starting: bool = False) -> Verdict:
    """Where the robot may not go now. `rear` is None for a robot without a sensor there."""
    if emergency:
        return Verdict.EMERGENCY_STOP
    if starting:
        return Verdict.STARTING
    forward_bad, backward_bad = front != Sight.FREE, rear not in (None, Sight.FREE)
    if forward_bad and backward_bad:
        return Verdict.BLOCKED
    if forward_bad:
        return Verdict.BLOCKED_FORWARD
    return Verdict.BLOCKED_BACKWARD if backward_bad else Verdict.FREE


def allowed(speed_m_s: float, verdict: Verdict, shares: Shares = Shares()) -> float:
    """How much of a speed may reach the motors, 0 to 1; of no speed, of one forward."""
    if verdict in _CLOSED:
        return 0.0
    forbidden = (verdict == Verdict.BLOCKED_FORWARD and speed_m_s >= 0) or (
        verdict == Verdict.BLOCKED_BACKWARD and speed_m_s < 0
    )
    return 0.0 if forbidden else shares.towards(speed_m_s)


def gate(command: DriveSetpoint, verdict: Verdict, shares: Shares = Shares()) -> DriveSetpoint:
    """What of a command may reach the motors: all of it, a slower one, or a stop."""
    if not (math.isfinite(command.speed_m_s) and math.isfinite(command.steering_rad)):
        return STOP
    if verdict in _CLOSED:
        return STOP
    part = allowed(command.speed_m_s, verdict, shares)
    # The wheels may still be turned: a way out has to be steered to.
    return DriveSetpoint(command.speed_m_s * part if part else 0.0, command.steering_rad)

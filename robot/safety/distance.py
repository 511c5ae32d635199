"""When the robot may move: what a distance means, and how it changes a command.

When in doubt it stops: a silent or broken sensor counts as an obstacle. Between the slow and the
critical distance a command is slowed in proportion, so that the robot stops gently; the steering
is left unchanged.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from robot.words import STOP, DriveSetpoint


class RangeState(str, Enum):
    """What a distance sensor reports about the way ahead of it."""

    FREE = "free"
    CLOSE = "close"
    """An obstacle nearer than the critical distance."""
    INVALID = "invalid"
    """The newest reading is not a distance."""
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
    """The gate has just started and may not know of an emergency stop yet."""


_CLOSED = (Verdict.BLOCKED, Verdict.EMERGENCY_STOP, Verdict.STARTING)


@dataclass(frozen=True)
class Reading:
    """The newest reading of a distance sensor."""

    distance_m: float | None = None
    """By REP-117: +inf nothing in range, -inf too close to measure, nan no valid reading; None if
    there has been none at all."""
    age_s: float = 0.0


@dataclass(frozen=True)
class SafetyZone:
    """The distances and the silence at which the robot slows or stops."""

    critical_m: float = 0.5
    """Nearer than this, the robot does not move that way."""
    slow_m: float = 0.0
    """Nearer than this, it is slowed; no slowing unless above `critical_m`."""
    stale_after_s: float = 2.5
    """The longest harmless silence."""


@dataclass(frozen=True)
class Shares:
    """The share of the requested speed that is allowed, 0 to 1."""

    forward: float = 1.0
    backward: float = 1.0

    def towards(self, speed_m_s: float) -> float:
        """Return the share for this speed; for a standing robot, the forward share."""
        return self.backward if speed_m_s < 0 else self.forward


def range_state(reading: Reading, critical_m: float, stale_after_s: float) -> RangeState:
    """Judge a reading; `stale_after_s` is the longest harmless silence."""
    if reading.distance_m is None or not reading.age_s <= stale_after_s:
        return RangeState.SILENT
    if math.isnan(reading.distance_m) or -math.inf < reading.distance_m < 0.0:
        return RangeState.INVALID
    return RangeState.CLOSE if reading.distance_m < critical_m else RangeState.FREE


def share(reading: Reading, zone: SafetyZone) -> float:
    """Return the share of a speed towards that sensor's side that is allowed, 0 to 1.

    0 where `range_state` finds no free way, 1 beyond the slow distance, and in between linear from
    0 at the critical distance.
    """
    if range_state(reading, zone.critical_m, zone.stale_after_s) != RangeState.FREE:
        return 0.0
    distance_m = reading.distance_m
    if distance_m is None or distance_m >= zone.slow_m:
        return 1.0
    return (distance_m - zone.critical_m) / (zone.slow_m - zone.critical_m)


def where(front: RangeState, rear: RangeState | None, emergency: bool, *, starting: bool = False) -> Verdict:
    """Return where the robot may not go now. `rear` is None for a robot without a sensor there."""
    if emergency:
        return Verdict.EMERGENCY_STOP
    if starting:
        return Verdict.STARTING
    forward_bad, backward_bad = front != RangeState.FREE, rear not in (None, RangeState.FREE)
    if forward_bad and backward_bad:
        return Verdict.BLOCKED
    if forward_bad:
        return Verdict.BLOCKED_FORWARD
    return Verdict.BLOCKED_BACKWARD if backward_bad else Verdict.FREE


def allowed(speed_m_s: float, verdict: Verdict, shares: Shares = Shares()) -> float:
    """Return the share of a speed that may reach the motors, 0 to 1; zero counts as forward."""
    if verdict in _CLOSED:
        return 0.0
    forbidden = (verdict == Verdict.BLOCKED_FORWARD and speed_m_s >= 0) or (
        verdict == Verdict.BLOCKED_BACKWARD and speed_m_s < 0
    )
    return 0.0 if forbidden else shares.towards(speed_m_s)


def gate(command: DriveSetpoint, verdict: Verdict, shares: Shares = Shares()) -> DriveSetpoint:
    """Return what may reach the motors: the whole command, a slower one, or a stop."""
    if not (math.isfinite(command.speed_m_s) and math.isfinite(command.steering_rad)):
        return STOP
    if verdict in _CLOSED:
        return STOP
    part = allowed(command.speed_m_s, verdict, shares)
    # The wheels may still be steered, as a way out needs steering.
    return DriveSetpoint(command.speed_m_s * part if part else 0.0, command.steering_rad)

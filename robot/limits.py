"""How far the robot may be asked to go, whoever asks.

Each step on the way to the motors holds to these, and none trusts the one before it. What lies
beyond them nobody can have meant: it is refused, which is a stop. Parameters of nodes may set
lower limits; to those a command is slowed. To make a robot faster, change this file.
"""

from __future__ import annotations

from dataclasses import dataclass

from robot.kinematics import WHEEL_RADIUS_M, wheel_speeds

_ROUNDING = 1e-6
"""A share of the limit: 0.3 is a little more in the 32 bits of a /drive."""


@dataclass(frozen=True)
class Limits:
    """A closed range and its unit."""

    low: float
    high: float
    unit: str

    def __contains__(self, value: object) -> bool:
        """Whether a number lies inside; nan never does."""
        return isinstance(value, (int, float)) and self.low <= value <= self.high

    def allow(self, value: float) -> bool:
        """Whether a number lies inside, but for what rounding has added to it."""
        more = _ROUNDING * max(abs(self.low), abs(self.high))
        return self.low - more <= value <= self.high + more

    def clamped(self, value: float) -> float:
        """The nearest number inside."""
        return max(self.low, min(self.high, value))


SPEED = Limits(-0.5, 0.5, "m/s")
"""Of the middle of the rear axle."""
STEERING = Limits(-0.5, 0.5, "rad")
RIM_M_S = wheel_speeds(SPEED.high, STEERING.high).right_m_s
"""No wheel is driven faster, at its rim: the outer one of the tightest curve at full speed is."""
PICO_RAD_S = 17.907
"""What the Pico lets a wheel be asked for, as in firmware/pico2/config.py."""


def wheel_limits(radius_m: float = WHEEL_RADIUS_M) -> Limits:
    """How fast a wheel of this radius may turn: its rim goes by `RIM_M_S` at the most."""
    most = RIM_M_S / radius_m
    return Limits(-most, most, "rad/s")


@dataclass(frozen=True)
class Excess:
    """A number that was asked for and lies beyond its limits, or is none."""

    value: float
    limits: Limits

    def __str__(self) -> str:
        """For programs: `1e+30 m/s, limit 0.5 m/s`."""
        unit = self.limits.unit
        return f"{self.value:g} {unit}, limit {self.limits.high:g} {unit}"


def first_excess(*asked: tuple[float, Limits]) -> Excess | None:
    """The first of these numbers that is no number or lies beyond its limits, None if all fit."""
    return next((Excess(*one) for one in asked if not one[1].allow(one[0])), None)


HEAD_ANGLE = Limits(-90, 90, "deg")
"""Pan and tilt, in whole degrees."""
MAX_COMMANDS = 32
"""Commands in one response of an LLM."""
MAX_BYTES = 64 * 1024
"""Size of one response of an LLM."""

"""Limits of what anybody may ask of the robot.

Every step on the way to the motors enforces them, and none trusts the previous one. A command
beyond them must be an error: it is refused, which is a stop. Node parameters may set lower limits;
commands are slowed down to those. To make a robot faster, change this file.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from robot.kinematics import WHEEL_RADIUS_M, wheel_speeds

_ROUNDING = 1e-6
"""Tolerance as a share of the limit: 0.3 is a little more in the 32 bits of a /drive."""


@dataclass(frozen=True)
class Limits:
    """A closed range and its unit."""

    low: float
    high: float
    unit: str

    def __contains__(self, value: object) -> bool:
        """Whether a number is within the range; nan never is."""
        return isinstance(value, (int, float)) and self.low <= value <= self.high

    def allow(self, value: float) -> bool:
        """Whether a number is within the range, apart from rounding."""
        more = _ROUNDING * max(abs(self.low), abs(self.high))
        return self.low - more <= value <= self.high + more

    def clamped(self, value: float) -> float:
        """Return the nearest number within the range."""
        return max(self.low, min(self.high, value))


SPEED = Limits(-0.5, 0.5, "m/s")
"""Speed of the middle of the rear axle."""
STEERING = Limits(-0.5, 0.5, "rad")
RIM_M_S = wheel_speeds(SPEED.high, STEERING.high).right_m_s
"""Maximum rim speed of a wheel: reached by the outer one in the tightest curve at full speed."""
PICO_RAD_S = 17.907
"""What the Pico accepts for a wheel, as in firmware/pico2/config.py."""


def wheel_limits(radius_m: float = WHEEL_RADIUS_M) -> Limits:
    """Return how fast a wheel of this radius may turn: its rim moves at `RIM_M_S` at most."""
    most = RIM_M_S / radius_m
    return Limits(-most, most, "rad/s")


@dataclass(frozen=True)
class Excess:
    """A requested value that is beyond its limits, or not a number."""

    value: float
    limits: Limits

    def __str__(self) -> str:
        """For programs: `1e+30 m/s, limit 0.5 m/s`."""
        unit = self.limits.unit
        return f"{self.value:g} {unit}, limit {self.limits.high:g} {unit}"


def first_excess(*asked: tuple[float, Limits]) -> Excess | None:
    """Return the first value that is not a number or beyond its limits, None if all are fine."""
    return next((Excess(*one) for one in asked if not one[1].allow(one[0])), None)


HEAD_ANGLE = Limits(-90, 90, "deg")
"""Pan and tilt, in whole degrees."""
OF_COMMANDS: Mapping[str, Limits] = MappingProxyType(
    {"speed": SPEED, "steering": STEERING, "pan": HEAD_ANGLE, "tilt": HEAD_ANGLE}
)
"""By the field of an LLM's command."""
MAX_COMMANDS = 32
"""Maximum commands in one response of an LLM."""
MAX_BYTES = 64 * 1024
"""Maximum size of one response of an LLM."""

"""The motion of the wheels, read from a JointState, and what it means."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from robot.joints import REAR_LEFT_WHEEL, REAR_RIGHT_WHEEL, STEERING
from robot.kinematics import WHEEL_RADIUS_M, turning_radius
from text.i18n import _

STANDING_BELOW_M_S = 0.005
EVEN_WITHIN_M_S = 0.003
FARTHEST_RAD = math.pi
"""Larger angles are invalid: an angle cannot express more than half a turn."""


@dataclass(frozen=True)
class WheelsReading:
    """Speeds of the rear wheels at the rim, and the angle of the front wheels, + is left."""

    left_m_s: float
    right_m_s: float
    steering_rad: float

    @property
    def radius_m(self) -> float:
        """Turning radius, positive to the left, inf when straight, nan if there is no circle."""
        try:
            return turning_radius(self.steering_rad)
        except ValueError:
            return math.nan

    @property
    def words(self) -> str:
        """Say which wheel is slower, or that they stand or turn alike."""
        left, right = abs(self.left_m_s), abs(self.right_m_s)
        if not (math.isfinite(left) and math.isfinite(right)):
            return _("not a number")
        if max(left, right) < STANDING_BELOW_M_S:
            return _("standing")
        back = self.left_m_s + self.right_m_s < 0
        if abs(left - right) < EVEN_WITHIN_M_S:
            return _("straight back") if back else _("straight")
        if left < right:
            return _("left wheel slower")
        return _("right wheel slower")


def can_be_turned_to(steering_rad: float) -> bool:
    """Whether this can be the angle of a wheel: finite, and at most half a turn."""
    return abs(steering_rad) <= FARTHEST_RAD


def wheels_in(value: Mapping[str, Any], wheel_radius_m: float = WHEEL_RADIUS_M) -> WheelsReading | None:
    """Read a sensor_msgs/JointState; None if it is not about these wheels.

    A missing joint is read as nan.
    """
    names = [str(name) for name in value.get("name", ())]
    if REAR_LEFT_WHEEL not in names and REAR_RIGHT_WHEEL not in names:
        return None

    def read(array: str, joint: str) -> float:
        numbers = value.get(array, ())
        at = names.index(joint) if joint in names else len(numbers)
        return float(numbers[at]) if at < len(numbers) else math.nan

    return WheelsReading(
        read("velocity", REAR_LEFT_WHEEL) * wheel_radius_m,
        read("velocity", REAR_RIGHT_WHEEL) * wheel_radius_m,
        read("position", STEERING),
    )

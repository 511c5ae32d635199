"""The electronic differential: how fast each rear wheel turns on a curve.

The chassis steers like a car (Ackermann) and drives each rear wheel with its own motor, without a
mechanical differential, so the software has to slow down the inner wheel.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

WHEELBASE_M = 0.25
"""Distance between the front and the rear axle."""
TRACK_M = 0.15
"""Distance between the two rear wheels."""
WHEEL_RADIUS_M = 0.0325
"""Radius of a driven wheel."""
LENGTH_M, BEHIND_M = 0.35, 0.05
"""Of the robot, and of what is behind its rear axle."""
STRAIGHT_BELOW_RAD = 0.01
"""Steering angles smaller than this count as straight ahead."""
STEERING_LIMIT_RAD = math.pi / 2
"""At this angle the front wheels are perpendicular: no turning circle exists beyond it."""


@dataclass(frozen=True)
class WheelSpeeds:
    """Rim speeds of the rear wheels, and the circle that the robot drives."""

    left_m_s: float
    right_m_s: float
    radius_m: float
    """Turning radius of the middle of the rear axle, + is to the left; inf when straight."""

    @property
    def fastest_m_s(self) -> float:
        """Absolute speed of the faster wheel."""
        return max(abs(self.left_m_s), abs(self.right_m_s))

    def slowed_to(self, most_m_s: float) -> WheelSpeeds:
        """Return both speeds scaled down to this maximum at the faster wheel: the same circle."""
        if self.fastest_m_s <= most_m_s:
            return self
        part = most_m_s / self.fastest_m_s
        return WheelSpeeds(self.left_m_s * part, self.right_m_s * part, self.radius_m)


def turning_radius(steering_rad: float, wheelbase_m: float = WHEELBASE_M) -> float:
    """Return the radius in metres of the circle of the rear axle: R = L / tan(delta).

    Positive to the left, `math.inf` when straight. Raises ValueError if `steering_rad` is not
    a number smaller than a right angle, or `wheelbase_m` is not greater than 0.
    """
    if not abs(steering_rad) < STEERING_LIMIT_RAD:
        raise ValueError(f"steering must be smaller than a right angle, not {steering_rad} rad")
    if not 0.0 < wheelbase_m < math.inf:
        raise ValueError(f"the wheelbase must be greater than 0, not {wheelbase_m} m")
    if abs(steering_rad) < STRAIGHT_BELOW_RAD:
        return math.inf
    return wheelbase_m / math.tan(steering_rad)


def wheel_speeds(
    speed_m_s: float, steering_rad: float, wheelbase_m: float = WHEELBASE_M, track_m: float = TRACK_M
) -> WheelSpeeds:
    """Return the rear wheels' speeds for a speed of the rear axle and a steering angle (+ is left).

    v_left = v (1 - W / 2R), v_right = v (1 + W / 2R). Raises ValueError for a speed that is not
    finite, an angle without a circle (see `turning_radius`), or impossible dimensions.
    """
    if not math.isfinite(speed_m_s):
        raise ValueError(f"the speed must be a finite number, not {speed_m_s} m/s")
    if not 0.0 < track_m < math.inf:
        raise ValueError(f"the track must be greater than 0, not {track_m} m")
    radius_m = turning_radius(steering_rad, wheelbase_m)
    share = track_m / (2.0 * radius_m)
    return WheelSpeeds(speed_m_s * (1.0 - share), speed_m_s * (1.0 + share), radius_m)

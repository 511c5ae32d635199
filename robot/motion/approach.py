"""How to drive a car-like robot to a point: the control law, and when to give up.

A point that lies on a drivable circle through the robot is reached along that circle (pure
pursuit), forward if it is ahead, in reverse if it is close behind. The robot turns towards a far
point behind first. A point beside it, inside its tightest circle, cannot be reached directly: the
robot backs away from it with the wheels turned the other way, as in a three-point turn, until it
can be.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from robot.kinematics import WHEELBASE_M, turning_radius
from robot.limits import SPEED, STEERING
from robot.motion.odometry import Point, Pose
from robot.words import STOP, DriveSetpoint

SPEED_STEP_M_S = 0.05
STEERING_STEP_RAD = 0.02
"""Commands are rounded to these, so that a new one is sent only if it makes a difference."""
_SLOWING_1_S = 0.8
"""Speed per metre that is left."""
_COMFORT = 0.7
"""The share of the steering limit at which the robot has backed away enough."""
_REVERSE_WITHIN_M = 1.0
_REVERSE_WITHIN_CIRCLES = 2.5
"""The robot reverses to a point within the larger of these, the second in turning radii."""


@dataclass(frozen=True)
class ApproachLimits:
    """What the control law knows about the robot and may demand of it."""

    max_speed_m_s: float = 0.3
    max_steering_rad: float = STEERING.high
    wheelbase_m: float = WHEELBASE_M

    def __post_init__(self) -> None:
        """Raise ValueError for what no command may demand."""
        if not (0.0 < self.max_speed_m_s <= SPEED.high):
            raise ValueError(f"speed must be up to {SPEED.high} m/s, not {self.max_speed_m_s}")
        if not (0.0 < self.max_steering_rad <= STEERING.high):
            raise ValueError(f"steering must be up to {STEERING.high} rad, not {self.max_steering_rad}")
        turning_radius(self.max_steering_rad, self.wheelbase_m)

    @property
    def tightest_m(self) -> float:
        return turning_radius(self.max_steering_rad, self.wheelbase_m)


class Approach:
    """One way to one point; called again with every new pose."""

    def __init__(self, goal: Point, tolerance_m: float, chassis: ApproachLimits) -> None:
        self.goal = goal
        self.tolerance_m = tolerance_m
        self._chassis = chassis
        self._backing_away = False

    def reached(self, pose: Pose) -> bool:
        """Whether the robot is within the tolerance."""
        return pose.distance_to(self.goal) <= self.tolerance_m

    def command(self, pose: Pose) -> DriveSetpoint:
        """Return what to do now; a stop once the point is reached."""
        if self.reached(pose):
            return STOP
        ahead_m, left_m = pose.sees(self.goal)
        distance_m = math.hypot(ahead_m, left_m)
        gear = self._gear(ahead_m, distance_m)
        steering = math.atan(self._chassis.wheelbase_m * 2.0 * left_m / distance_m**2)
        sharpest = self._chassis.max_steering_rad
        if self._must_back_away(gear * ahead_m, left_m, steering):
            return self._limited(-gear * self._chassis.max_speed_m_s / 2, -_side(left_m) * sharpest)
        if gear * ahead_m < 0:
            steering = _side(left_m) * sharpest
        return self._limited(gear * distance_m * _SLOWING_1_S, steering)

    def _gear(self, ahead_m: float, distance_m: float) -> int:
        """Return 1 for forward, -1 for reverse."""
        near_m = max(_REVERSE_WITHIN_M, _REVERSE_WITHIN_CIRCLES * self._chassis.tightest_m)
        return -1 if ahead_m < 0 and distance_m < near_m else 1

    def _must_back_away(self, along_m: float, left_m: float, steering_rad: float) -> bool:
        """Whether the tightest circle would miss a point this far along the way and to the left."""
        if self._backing_away:
            enough = abs(steering_rad) <= _COMFORT * self._chassis.max_steering_rad
            self._backing_away = not enough
        elif along_m >= 0:
            radius_m = self._chassis.tightest_m
            missed_by_m = radius_m - math.hypot(along_m, abs(left_m) - radius_m)
            self._backing_away = missed_by_m > _COMFORT * self.tolerance_m
        return self._backing_away

    def _limited(self, speed_m_s: float, steering_rad: float) -> DriveSetpoint:
        """Return the command rounded, at least one step fast, within the limits of the chassis."""
        fastest, sharpest = self._chassis.max_speed_m_s, self._chassis.max_steering_rad
        speed = max(SPEED_STEP_M_S, _rounded(abs(speed_m_s), SPEED_STEP_M_S))
        steering = _rounded(steering_rad, STEERING_STEP_RAD)
        return DriveSetpoint(math.copysign(min(fastest, speed), speed_m_s), max(-sharpest, min(sharpest, steering)))

    def longest_way_m(self, start: Pose) -> float:
        """Return an upper bound for any way from there, turns and three-point turns included."""
        circle_m = math.tau * self._chassis.tightest_m
        return 2.0 * start.distance_to(self.goal) + 3.0 * circle_m + 1.0


class ApproachProgress:
    """Notices a robot that stands although it should drive, or drives but does not arrive."""

    def __init__(self, longest_way_m: float, patience_s: float, pose: Pose, now_s: float) -> None:
        self.stands = False
        """Whether it has not moved for longer than the patience."""
        self._left_m = longest_way_m
        self._patience_s = patience_s
        self._last = self._resting = pose
        self._moved_s = now_s

    @property
    def has_driven_too_far(self) -> bool:
        """Whether it has driven farther than any way there could be."""
        return self._left_m < 0

    def take(self, pose: Pose, now_s: float) -> None:
        """Add the newest pose, and the time in seconds of a clock that never jumps."""
        self._left_m -= self._last.distance_to(pose)
        self._last = pose
        turned = abs(math.remainder(pose.heading_rad - self._resting.heading_rad, math.tau))
        if self._resting.distance_to(pose) > STIR_M or turned > STIR_RAD:
            self._resting, self._moved_s = pose, now_s
        self.stands = now_s - self._moved_s > self._patience_s


STIR_M = 0.02
STIR_RAD = 0.05
"""Less than this is a slipping wheel or jittering odometry."""


def _rounded(value: float, step: float) -> float:
    return round(value / step) * step


def _side(left_m: float) -> float:
    return 1.0 if left_m >= 0 else -1.0

"""Where the robot is on the floor, and where a command takes it: the bicycle model.

The frame is that of the odometry (x forward at the start, y to the left, metres); the robot's
reference point is the middle of its rear axle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from robot.kinematics import WHEELBASE_M, turning_radius
from robot.words import DriveSetpoint


@dataclass(frozen=True)
class Point:
    """A place on the floor, metres."""

    x_m: float
    y_m: float


@dataclass(frozen=True)
class Pose:
    """The robot's position and heading."""

    x_m: float = 0.0
    y_m: float = 0.0
    heading_rad: float = 0.0
    """Angle from the x axis, + is left; between -pi and pi."""

    @property
    def is_finite(self) -> bool:
        return all(map(math.isfinite, (self.x_m, self.y_m, self.heading_rad)))

    def distance_to(self, point: Point | Pose) -> float:
        """Return the straight-line distance in metres."""
        return math.hypot(point.x_m - self.x_m, point.y_m - self.y_m)

    def sees(self, point: Point) -> tuple[float, float]:
        """Return how far a point lies ahead and to the left of the robot, metres."""
        east, north = point.x_m - self.x_m, point.y_m - self.y_m
        cos, sin = math.cos(self.heading_rad), math.sin(self.heading_rad)
        return cos * east + sin * north, cos * north - sin * east


def advance(pose: Pose, command: DriveSetpoint, seconds: float, wheelbase_m: float = WHEELBASE_M) -> Pose:
    """Return the pose after obeying a command for some seconds, along the exact arc.

    Raises ValueError for a steering angle without a circle (see `turning_radius`).
    """
    travelled_m = command.speed_m_s * seconds
    radius_m = turning_radius(command.steering_rad, wheelbase_m)
    heading = pose.heading_rad
    if math.isinf(radius_m):
        return Pose(pose.x_m + travelled_m * math.cos(heading), pose.y_m + travelled_m * math.sin(heading), heading)
    turned = heading + travelled_m / radius_m
    return Pose(
        pose.x_m + radius_m * (math.sin(turned) - math.sin(heading)),
        pose.y_m - radius_m * (math.cos(turned) - math.cos(heading)),
        math.remainder(turned, math.tau),
    )


def yaw_from_quaternion(x: float, y: float, z: float, w: float) -> float:
    """Return the rotation about z in radians, for a quaternion of any length; nan for length 0."""
    length = x * x + y * y + z * z + w * w
    if not 0.0 < length < math.inf:
        return math.nan
    return math.atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)

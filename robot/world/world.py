"""A simulated robot in a simulated room: the same commands give the same drive.

Time passes in steps of `STEP_S`. Each rear wheel follows its command with a lag, the steering turns
at its own pace, the robot moves by the bicycle model, and stops where it touches something. No
clock is read, and all randomness is seeded.
"""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from robot.kinematics import BEHIND_M, LENGTH_M, WHEEL_RADIUS_M, WHEELBASE_M
from robot.motion.odometry import Pose, advance
from robot.words import DriveSetpoint


@dataclass(frozen=True)
class Box:
    """An upright rectangle, metres and radians."""

    x_m: float
    y_m: float
    length_m: float
    """Size along its own x axis."""
    width_m: float
    heading_rad: float = 0.0

    def corners(self) -> list[tuple[float, float]]:
        """Its four corners, counter-clockwise."""
        cos, sin = math.cos(self.heading_rad), math.sin(self.heading_rad)
        halves = ((0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5))
        sides = [(a * self.length_m, b * self.width_m) for a, b in halves]
        return [(self.x_m + a * cos - b * sin, self.y_m + a * sin + b * cos) for a, b in sides]


class Room:
    """A box of walls, and boxes in it."""

    def __init__(self, walls: Box, boxes: Sequence[Box] = ()) -> None:
        self.walls, self.boxes = walls, tuple(boxes)
        loops = [np.array(box.corners()) for box in (walls, *boxes)]
        self._begins = np.concatenate(loops)
        self._along = np.concatenate([np.roll(loop, -1, axis=0) - loop for loop in loops])
        self._lengths2 = (self._along**2).sum(axis=1)

    def distance(self, x_m: float, y_m: float, heading_rad: float) -> float:
        """Return the metres from a point to the first obstacle in a direction, inf without one."""
        ray = math.cos(heading_rad), math.sin(heading_rad)
        to_begin = self._begins - (x_m, y_m)
        across = _cross(self._along, ray)
        with np.errstate(all="ignore"):
            share = _cross(to_begin, ray) / -across
            reach = _cross(to_begin, self._along) / -across
        hit = (share >= -1e-9) & (share <= 1 + 1e-9) & (reach >= 0.0)
        return float(reach[hit].min()) if hit.any() else math.inf

    def clearance(self, x_m: float, y_m: float) -> float:
        """Return the metres from a point to the nearest wall."""
        from_begin = np.array((x_m, y_m)) - self._begins
        share = np.clip((from_begin * self._along).sum(axis=1) / self._lengths2, 0.0, 1.0)
        gaps = from_begin - share[:, None] * self._along
        return float(np.sqrt((gaps**2).sum(axis=1).min()))

    def touches(self, box: Box) -> bool:
        corners = np.array(box.corners())
        edges = np.roll(corners, -1, axis=0) - corners
        return any(self._crossed(corner, edge) for corner, edge in zip(corners, edges, strict=True)) or any(
            _inside(point, box) for point in self._begins
        )

    def _crossed(self, begin: NDArray[np.float64], edge: NDArray[np.float64]) -> bool:
        to_begin = self._begins - begin
        along = (float(edge[0]), float(edge[1]))
        across = _cross(self._along, along)
        with np.errstate(all="ignore"):
            on_wall = _cross(to_begin, along) / -across
            on_edge = _cross(to_begin, self._along) / -across
        return bool(((on_wall >= 0) & (on_wall <= 1) & (on_edge >= 0) & (on_edge <= 1)).any())


def _cross(rows: NDArray[np.float64], other: tuple[float, float] | NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the cross product of each row with a vector, or with the row of the same index."""
    x, y = (other[:, 0], other[:, 1]) if isinstance(other, np.ndarray) else other
    result: NDArray[np.float64] = rows[:, 0] * y - rows[:, 1] * x
    return result


def _inside(point: NDArray[np.float64], box: Box) -> bool:
    east, north = float(point[0]) - box.x_m, float(point[1]) - box.y_m
    cos, sin = math.cos(box.heading_rad), math.sin(box.heading_rad)
    ahead, left = cos * east + sin * north, cos * north - sin * east
    return abs(ahead) <= box.length_m / 2 and abs(left) <= box.width_m / 2


LIVING_ROOM = Room(
    Box(1.5, 0.0, 5.0, 4.0), (Box(2.2, 0.2, 0.4, 0.5, 0.4), Box(0.8, -1.2, 0.6, 0.4), Box(3.2, -1.0, 0.3, 0.3, 0.8))
)
"""The robot starts at the origin, 1 m from the wall behind it and 2 m from those beside it."""


STEP_S = 0.01
_AWAY_M = 0.02


@dataclass(frozen=True)
class Body:
    """Dimensions of the robot. Its reference point is the middle of the rear axle."""

    wheelbase_m: float = WHEELBASE_M
    wheel_radius_m: float = WHEEL_RADIUS_M
    length_m: float = LENGTH_M
    width_m: float = 0.20
    behind_m: float = BEHIND_M
    motor_lag_s: float = 0.08
    """A wheel completes 63 % of a speed change in this time."""
    braking_m_s2: float = 2.5
    """A wheel that should stop decelerates at least this fast."""
    steering_rad_s: float = 5.0
    max_wheel_rad_s: float = 20.0
    max_steering_rad: float = 0.6

    def outline(self, pose: Pose) -> Box:
        """Return the floor area that it covers."""
        ahead_m = self.length_m / 2 - self.behind_m
        x_m = pose.x_m + ahead_m * math.cos(pose.heading_rad)
        y_m = pose.y_m + ahead_m * math.sin(pose.heading_rad)
        return Box(x_m, y_m, self.length_m, self.width_m, pose.heading_rad)


@dataclass
class Wheels:
    """Two rear wheels and the steering; as commanded, or as they are."""

    left_rad_s: float = 0.0
    right_rad_s: float = 0.0
    steering_rad: float = 0.0


@dataclass(frozen=True)
class SimulatedSonar:
    """A distance sensor at a bumper, facing forward or backward."""

    forward: bool = True
    nearest_m: float = 0.2
    farthest_m: float = 8.0
    noise_m: float = 0.01
    """Standard deviation of the noise."""
    dropout: float = 0.01
    """Share of invalid readings."""
    rays_rad: tuple[float, ...] = (-0.02, 0.0, 0.02)
    """Directions within its beam; the nearest counts."""

    def true_m(self, room: Room, body: Body, pose: Pose) -> float:
        """Return what a perfect sensor without limits would measure."""
        offset_m = body.length_m - body.behind_m if self.forward else -body.behind_m
        x_m = pose.x_m + offset_m * math.cos(pose.heading_rad)
        y_m = pose.y_m + offset_m * math.sin(pose.heading_rad)
        heading = pose.heading_rad + (0.0 if self.forward else math.pi)
        return min(room.distance(x_m, y_m, heading + ray) for ray in self.rays_rad)

    def read(self, room: Room, body: Body, pose: Pose, dice: random.Random) -> float:
        """Read by REP-117: +inf nothing in range, -inf too close, nan no valid reading."""
        noise_m, dropped = dice.gauss(0.0, self.noise_m), dice.random() < self.dropout
        if dropped:
            return math.nan
        metres = self.true_m(room, body, pose) + noise_m
        if metres < self.nearest_m:
            return -math.inf
        return metres if metres <= self.farthest_m else math.inf


@dataclass
class World:
    """The room, the robot, and its state so far."""

    room: Room = LIVING_ROOM
    body: Body = Body()
    pose: Pose = field(default_factory=Pose)
    seed: int = 0
    front: SimulatedSonar = SimulatedSonar()
    rear: SimulatedSonar = SimulatedSonar(forward=False)
    asked: Wheels = field(default_factory=Wheels)
    """The command to the wheels; set from outside."""
    stalled: tuple[bool, bool] = (False, False)
    """Whether the left and the right motor are stalled."""
    wheels: Wheels = field(default_factory=Wheels)
    steps: int = 0
    collisions: int = 0
    """How often the robot has run into something."""
    _dice: random.Random = field(init=False, repr=False)
    _free_m: float = field(default=0.0, init=False, repr=False)
    """How far the robot may move before it can touch anything."""
    _since_hit_m: float = field(default=math.inf, init=False, repr=False)

    def __post_init__(self) -> None:
        self._dice = random.Random(self.seed)

    @property
    def speed_m_s(self) -> float:
        """Speed of the rear axle, + forward."""
        mean_rad_s = (self.wheels.left_rad_s + self.wheels.right_rad_s) / 2
        return mean_rad_s * self.body.wheel_radius_m

    def step(self) -> None:
        self.steps += 1
        self._turn_wheels()
        command = DriveSetpoint(self.speed_m_s, self.wheels.steering_rad)
        if command.speed_m_s == 0.0:
            return
        pose = advance(self.pose, command, STEP_S, self.body.wheelbase_m)
        moved_m = abs(command.speed_m_s) * STEP_S
        if self._would_touch(pose, moved_m):
            # Leaning on a wall is not a new collision.
            self.collisions += self._since_hit_m > _AWAY_M
            self._since_hit_m = 0.0
            self.wheels.left_rad_s = self.wheels.right_rad_s = 0.0
            return
        self._since_hit_m += moved_m
        self.pose = pose

    def read_sonars(self) -> tuple[float, float]:
        """Return front and rear in metres by REP-117; each call draws new noise."""
        front, rear = (sonar.read(self.room, self.body, self.pose, self._dice) for sonar in (self.front, self.rear))
        return front, rear

    def _turn_wheels(self) -> None:
        wheels, asked, body = self.wheels, self.asked, self.body
        wheels.left_rad_s = self._spin(wheels.left_rad_s, asked.left_rad_s, self.stalled[0])
        wheels.right_rad_s = self._spin(wheels.right_rad_s, asked.right_rad_s, self.stalled[1])
        most = body.steering_rad_s * STEP_S
        goal = _within(asked.steering_rad, body.max_steering_rad)
        wheels.steering_rad += _within(goal - wheels.steering_rad, most)

    def _spin(self, now: float, asked: float, stalled: bool) -> float:
        if stalled:
            return 0.0
        goal = _within(asked, self.body.max_wheel_rad_s)
        fresh = now + (goal - now) * (1.0 - math.exp(-STEP_S / self.body.motor_lag_s))
        if goal == 0.0:
            # Friction stops it completely, which a lag alone would only approach.
            loss = self.body.braking_m_s2 / self.body.wheel_radius_m * STEP_S
            fresh = math.copysign(max(0.0, min(abs(fresh), abs(now) - loss)), now)
        return fresh

    def _would_touch(self, pose: Pose, moved_m: float) -> bool:
        # No corner moves farther than the axle plus the rotation.
        turned = abs(math.remainder(pose.heading_rad - self.pose.heading_rad, math.tau))
        reach_m = math.hypot(self.body.length_m, self.body.width_m)
        self._free_m -= moved_m + turned * reach_m
        if self._free_m > 0.0:
            return False
        outline = self.body.outline(pose)
        around_m = math.hypot(outline.length_m, outline.width_m) / 2
        self._free_m = self.room.clearance(outline.x_m, outline.y_m) - around_m
        return self._free_m <= 0.0 and self.room.touches(outline)


def _within(value: float, most: float) -> float:
    return max(-most, min(most, value)) if math.isfinite(value) else 0.0

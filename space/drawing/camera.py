"""From where the scene is seen: from above, from the side, or turning about a point.

A camera turns points in metres into dots, x to the right and y downwards, with their depth in
metres: small is near. Dots are the picture's finest units, about square.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import Enum
from typing import TYPE_CHECKING

import numpy as np

from space.transform import turned

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from space.drawing.shapes import Places
    from space.transform import Vector

NEAREST_M = 0.05
"""What is nearer to the eye than this is not seen in perspective."""
OPENING_RAD = math.radians(50)
"""The angle between top and bottom of the picture, in perspective."""
LEAST_DOTS_PER_M, MOST_DOTS_PER_M = 0.01, 20_000.0
STEEPEST_RAD = math.pi / 2
FIT_HALVINGS, CENTRE_ROUNDS = 24, 3


class Angle(str, Enum):
    """The ways to look at the scene."""

    ABOVE = "above"
    """As on a map: x to the right, y upwards."""
    SIDE = "side"
    """Along y: x to the right, z upwards."""
    PERSPECTIVE = "perspective"


@dataclass(frozen=True)
class SpaceCamera:
    """A way to look at the scene, in a picture of `width` by `height` dots."""

    angle: Angle = Angle.ABOVE
    target: Vector = (0.0, 0.0, 0.0)
    """What is in the middle of the picture."""
    dots_per_m: float = 40.0
    """At the target."""
    yaw_rad: float = math.radians(60)
    """Where it looks, about z from x; only in perspective, as is the next."""
    pitch_rad: float = math.radians(35)
    """How far it looks down."""

    @property
    def turns(self) -> bool:
        return self.angle is Angle.PERSPECTIVE

    def basis(self) -> NDArray[np.float64]:
        """Return the picture's axes in space, as rows: to the right, upwards, and away."""
        yaw, pitch = {
            Angle.ABOVE: (math.pi / 2, math.pi / 2),
            Angle.SIDE: (math.pi / 2, 0.0),
            Angle.PERSPECTIVE: (self.yaw_rad, self.pitch_rad),
        }[self.angle]
        sy, cy, sp, cp = math.sin(yaw), math.cos(yaw), math.sin(pitch), math.cos(pitch)
        return np.array([[sy, -cy, 0.0], [sp * cy, sp * sy, cp], [cp * cy, cp * sy, -sp]])

    def distance_m(self, height: int) -> float:
        """Return how far the eye is from the target; in perspective only."""
        return self._focus(height) / self.dots_per_m

    def _focus(self, height: int) -> float:
        return height / 2 / math.tan(OPENING_RAD / 2)

    def seen(self, points: Places, height: int) -> Places:
        """Return points in the axes of the picture, in metres from the eye or the target."""
        basis = self.basis()
        x, y, z = -basis @ np.array(self.target)
        away = z + self.distance_m(height) if self.turns else z
        return turned(points, basis, (float(x), float(y), float(away))).astype(np.float32, copy=False)

    def on_picture(self, seen: Places, width: int, height: int) -> Places:
        """Return (x, y, depth) of points in the axes of the picture.

        In perspective, points nearer than NEAREST_M get NaN.
        """
        out = np.empty((3, len(seen)), dtype=np.float32).T
        scale: float | Places = self.dots_per_m
        depth = seen[:, 2]
        if self.turns:
            with np.errstate(divide="ignore"):
                scale = np.where(depth > NEAREST_M, self._focus(height) / depth, np.nan)
        np.multiply(seen[:, 0], scale, out=out[:, 0])
        np.multiply(seen[:, 1], scale, out=out[:, 1])
        out[:, 0] += width / 2
        out[:, 1] = height / 2 - out[:, 1]
        out[:, 2] = depth
        return out

    def project(self, points: Places, width: int, height: int) -> Places:
        """Return (x, y, depth) of points; see `on_picture`."""
        return self.on_picture(self.seen(points, height), width, height)

    def rays(
        self, x: NDArray[np.float64], y: NDArray[np.float64], width: int, height: int
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return where the rays through dots begin and their directions, both of shape (n, 3)."""
        right, up, away = self.basis()
        across, rise = x - width / 2, height / 2 - y
        target = np.array(self.target)
        if self.turns:
            focus = self._focus(height)
            ways = across[:, None] * right + rise[:, None] * up + focus * away
            eye = target - away * self.distance_m(height)
            return np.broadcast_to(eye, ways.shape), ways
        begins = target + (across[:, None] * right + rise[:, None] * up) / self.dots_per_m
        return begins, np.broadcast_to(away, begins.shape)

    def floor_at(self, x: float, y: float, width: int, height: int) -> tuple[float, float] | None:
        """Return the place on the floor (z = 0) below a dot; None if there is none."""
        begins, ways = self.rays(np.array([x]), np.array([y]), width, height)
        if abs(ways[0, 2]) < 1e-9:
            return None
        way = -begins[0, 2] / ways[0, 2]
        if way < 0 and self.turns:
            return None
        place = begins[0] + way * ways[0]
        return float(place[0]), float(place[1])

    def panned(self, right: float, down: float) -> SpaceCamera:
        """Return the camera after the picture was moved by this many dots."""
        across, up, away = self.basis()
        if self.turns:
            # Along the floor: what is held by the mouse stays at its height.
            up = np.array([math.cos(self.yaw_rad), math.sin(self.yaw_rad), 0.0])
            down /= max(0.3, abs(math.sin(self.pitch_rad)))
        del away
        place = np.array(self.target) + (down * up - right * across) / self.dots_per_m
        return replace(self, target=(float(place[0]), float(place[1]), float(place[2])))

    def zoomed(self, factor: float, right: float = 0.0, down: float = 0.0) -> SpaceCamera:
        """Return the camera `factor` times closer.

        What is `right` and `down` of the middle, in dots, stays there.
        """
        scale = min(max(self.dots_per_m * factor, LEAST_DOTS_PER_M), MOST_DOTS_PER_M)
        factor = scale / self.dots_per_m
        moved = self.panned(-right * (1 - 1 / factor), -down * (1 - 1 / factor))
        return replace(moved, dots_per_m=scale)

    def turned(self, yaw_rad: float, pitch_rad: float) -> SpaceCamera:
        """Return the camera after it went round the target; the other angles cannot turn."""
        if not self.turns:
            return self
        pitch = min(max(self.pitch_rad + pitch_rad, -STEEPEST_RAD), STEEPEST_RAD)
        return replace(self, yaw_rad=math.remainder(self.yaw_rad + yaw_rad, math.tau), pitch_rad=pitch)

    def fitting(self, least: Vector, most: Vector, width: int, height: int) -> SpaceCamera:
        """Return the camera that shows all of a box, as large as possible."""
        middle = tuple((a + b) / 2 for a, b in zip(least, most, strict=True))
        sides = [(a, b) for a, b in zip(least, most, strict=True)]
        corners = np.array([[x, y, z] for x in sides[0] for y in sides[1] for z in sides[2]], dtype=np.float32)
        camera = replace(self, target=(middle[0], middle[1], middle[2]))
        camera = _largest(camera, corners, width, height)
        for _round in range(CENTRE_ROUNDS if self.turns else 0):
            # In perspective the middle of a box is not in the middle of what it covers.
            spots = camera.project(corners, width, height)
            right, down = (spots.min(axis=0) + spots.max(axis=0))[:2] / 2
            across, up, _away = self.basis()
            way = (right - width / 2) * across - (down - height / 2) * up
            place = np.array(camera.target) + way / camera.dots_per_m
            moved = replace(camera, target=(float(place[0]), float(place[1]), float(place[2])))
            camera = _largest(moved, corners, width, height)
        return camera

    def shows(self, points: Places, width: int, height: int) -> bool:
        """Return whether all points are within the picture, a little away from its edge."""
        spots = self.project(points, width, height)
        inside = (spots[:, 0] >= 2) & (spots[:, 0] <= width - 2)
        inside &= (spots[:, 1] >= 2) & (spots[:, 1] <= height - 2)
        return bool(inside.all())


def _largest(camera: SpaceCamera, points: Places, width: int, height: int) -> SpaceCamera:
    """Return the camera as close as it can be with all points in the picture."""
    low, high = LEAST_DOTS_PER_M, MOST_DOTS_PER_M
    for _halving in range(FIT_HALVINGS):
        scale = math.sqrt(low * high)
        shown = replace(camera, dots_per_m=scale).shows(points, width, height)
        low, high = (scale, high) if shown else (low, scale)
    return replace(camera, dots_per_m=low)

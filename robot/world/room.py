"""A room with walls and boxes, seen from above: the length of rays, and contact with walls."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray


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

"""Where a simulated robot may stand: between the walls, and outside all boxes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robot.world.room import Box, Room


def on_free_floor(room: Room, x_m: float, y_m: float) -> bool:
    """Whether a point lies between the walls and outside all boxes."""
    return _covers(room.walls, x_m, y_m) and not any(_covers(box, x_m, y_m) for box in room.boxes)


def _covers(box: Box, x_m: float, y_m: float) -> bool:
    cos, sin = math.cos(box.heading_rad), math.sin(box.heading_rad)
    east, north = x_m - box.x_m, y_m - box.y_m
    along, across = cos * east + sin * north, cos * north - sin * east
    return abs(along) <= box.length_m / 2 and abs(across) <= box.width_m / 2

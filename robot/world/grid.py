"""A room as a map of square cells, as a robot would have mapped it: occupied, free, unknown."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot.world.world import Box, Room

OCCUPIED, FREE, UNKNOWN = 100, 0, -1
"""Cell values of nav_msgs/OccupancyGrid."""
CELL_M = 0.05
_MARGIN = 2
"""Unknown cells around the walls."""
_SAMPLES = 4
"""Points per cell sampled along a wall, so that no wall has gaps, whatever its angle."""


@dataclass(frozen=True)
class CellMap:
    """Cells with a side of `cell_m`, the first at the corner with the smallest x and y."""

    x_m: float
    y_m: float
    """Outer corner of the first cell."""
    cell_m: float
    cells: NDArray[np.int8]
    """Shape (rows, columns); rows count along y, columns along x."""


def grid_of(room: Room, cell_m: float = CELL_M) -> CellMap:
    """Draw a room: its walls and boxes are occupied, the floor between them is free."""
    corners = np.array(room.walls.corners())
    # Half a cell of offset: a wall parallel to the axes runs through the middle of its cells.
    least = corners.min(axis=0) - (_MARGIN + 0.5) * cell_m
    columns, rows = np.ceil((corners.max(axis=0) - least) / cell_m).astype(int) + _MARGIN
    centres = np.meshgrid(least[0] + (np.arange(columns) + 0.5) * cell_m, least[1] + (np.arange(rows) + 0.5) * cell_m)
    cells = np.full((rows, columns), UNKNOWN, dtype=np.int8)
    cells[_within(room.walls, *centres)] = FREE
    for box in room.boxes:
        cells[_within(box, *centres)] = OCCUPIED
    for box in (room.walls, *room.boxes):
        across, up = _edges(box, cell_m)
        cells[np.floor((up - least[1]) / cell_m).astype(int), np.floor((across - least[0]) / cell_m).astype(int)] = (
            OCCUPIED
        )
    return CellMap(float(least[0]), float(least[1]), cell_m, cells)


def _within(box: Box, x_m: NDArray[np.float64], y_m: NDArray[np.float64]) -> NDArray[np.bool_]:
    east, north = x_m - box.x_m, y_m - box.y_m
    cos, sin = math.cos(box.heading_rad), math.sin(box.heading_rad)
    ahead, left = np.abs(cos * east + sin * north), np.abs(cos * north - sin * east)
    inside: NDArray[np.bool_] = (ahead <= box.length_m / 2) & (left <= box.width_m / 2)
    return inside


def _edges(box: Box, cell_m: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return points along the outline of a box, x and y."""
    corners = box.corners()
    places = [
        np.linspace(begin, end, math.ceil(math.dist(begin, end) / cell_m * _SAMPLES) + 1)
        for begin, end in zip(corners, (*corners[1:], corners[0]), strict=True)
    ]
    together = np.concatenate(places)
    return together[:, 0], together[:, 1]

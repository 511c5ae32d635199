"""The simulated room as a map: walls where rays end, free floor between them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robot.world.grid import CELL_M, FREE, OCCUPIED, UNKNOWN, CellMap, grid_of
from robot.world.room import LIVING_ROOM, Box, Room


def cell_at(grid: CellMap, x_m: float, y_m: float) -> int:
    """Return the cell at a place."""
    row = math.floor((y_m - grid.y_m) / grid.cell_m)
    column = math.floor((x_m - grid.x_m) / grid.cell_m)
    return int(grid.cells[row, column])


@pytest.mark.parametrize("angle", [n * math.tau / 48 for n in range(48)])
def test_a_ray_through_free_cells_ends_at_an_occupied_one(angle: float) -> None:
    grid = grid_of(LIVING_ROOM)
    reach = LIVING_ROOM.distance(0.0, 0.0, angle)
    ray = math.cos(angle), math.sin(angle)
    assert cell_at(grid, reach * ray[0], reach * ray[1]) == OCCUPIED
    for metres in np.arange(0.0, reach - 2 * CELL_M, CELL_M / 2):
        assert cell_at(grid, metres * ray[0], metres * ray[1]) == FREE


def test_the_inside_is_free_boxes_are_full_and_nobody_knows_what_is_outside() -> None:
    grid = grid_of(LIVING_ROOM)
    box = LIVING_ROOM.boxes[0]
    assert cell_at(grid, box.x_m, box.y_m) == OCCUPIED
    assert cell_at(grid, -1.2, 0.0) == UNKNOWN
    assert set(np.unique(grid.cells)) == {OCCUPIED, FREE, UNKNOWN}
    assert set(grid.cells[0]) == set(grid.cells[:, -1]) == {UNKNOWN}
    free_m2 = np.count_nonzero(grid.cells == FREE) * grid.cell_m**2
    assert free_m2 == pytest.approx(5 * 4 - 0.2 - 0.24 - 0.09, rel=0.06)


def test_a_turned_room_has_no_holes_in_its_walls() -> None:
    room = Room(Box(0.0, 0.0, 3.0, 2.0, 0.5))
    grid = grid_of(room, 0.1)
    rows, columns = np.nonzero(grid.cells == FREE)
    for row, column in zip(rows, columns, strict=True):
        beside = grid.cells[row - 1 : row + 2 : 2, column].tolist()
        beside += grid.cells[row, column - 1 : column + 2 : 2].tolist()
        assert UNKNOWN not in beside

"""nav_msgs/OccupancyGrid: a floor of cells that are free, occupied or unknown."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from space.drawing.paints import Tint
from space.drawing.shapes import Floor
from space.reading.fields import FARTHEST_M, Drawable, NotDrawnError, field, frame, number, pose, stamp_s, whole
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from space.drawing.paints import Paints
    from space.transform import Transform

FREE_BELOW, OCCUPIED_FROM = 25, 65
"""The thresholds of nav2_map_server, of 100."""
MOST_CELLS = 4_000_000
"""Of a larger map only every second, third, ... cell is kept, the most occupied of its square."""


@dataclass(frozen=True, eq=False)
class GridCells:
    """The cells of a map, fewer and larger ones of a very large map."""

    cells: NDArray[np.int8]
    """Shape (rows, columns), the first at the origin, percent occupied; -1 for unknown."""
    cell_m: float
    origin: Transform


def read_grid(tree: Mapping[str, Any]) -> Drawable:
    """Return a map. Raises NotDrawnError."""
    grid = grid_cells(tree)
    floor = Floor(_painted(grid.cells), grid.cell_m, grid.origin)
    return Drawable(frame(tree), (floor,), stamp_s(tree))


def grid_cells(tree: Mapping[str, Any]) -> GridCells:
    """Return the cells of a map. Raises NotDrawnError."""
    rows, columns = whole(tree, "info.height"), whole(tree, "info.width")
    cell_m = number(tree, "info.resolution")
    if rows < 1 or columns < 1:
        raise NotDrawnError(say("a map of {columns} by {rows} cells has none", columns=columns, rows=rows))
    if not 0.0 < cell_m <= FARTHEST_M:
        raise NotDrawnError(say("info.resolution is {metres} m a cell", metres=f"{cell_m:g}"))
    data = field(tree, "data")
    cells = np.frombuffer(data, np.int8) if isinstance(data, bytes) else _small(data)
    if cells.size != rows * columns:
        raise NotDrawnError(
            say(
                "{columns} by {rows} cells are announced, and {count} have come",
                columns=columns,
                rows=rows,
                count=cells.size,
            )
        )
    stride = math.ceil(math.sqrt(cells.size / MOST_CELLS))
    kept = _fewer(cells.reshape(rows, columns), stride)
    return GridCells(kept, cell_m * stride, pose(tree, "info.origin"))


def _small(data: object) -> NDArray[np.int8]:
    try:
        return np.asarray(data).astype(np.int8).reshape(-1)
    except (TypeError, ValueError):
        raise NotDrawnError(say("{field} is not a list of numbers", field="data")) from None


def _fewer(cells: NDArray[np.int8], stride: int) -> NDArray[np.int8]:
    if stride == 1:
        return cells
    rows, columns = (size // stride for size in cells.shape)
    if not rows or not columns:
        return cells[::stride, ::stride]
    squares = cells[: rows * stride, : columns * stride]
    most: NDArray[np.int8] = squares.reshape(rows, stride, columns, stride).max(axis=(1, 3))
    return most


def _painted(cells: NDArray[np.int8]) -> Paints:
    paints = np.full(cells.shape, Tint.MAYBE, dtype=np.uint8)
    paints[cells < 0] = Tint.NOTHING
    paints[(cells >= 0) & (cells < FREE_BELOW)] = Tint.FREE
    paints[cells >= OCCUPIED_FROM] = Tint.WALL
    return paints

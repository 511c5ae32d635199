"""The data of the map, read from messages: pose, goal and room. Any input is tolerated."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from robot.motion.odometry import Point, Pose, yaw_from_quaternion
from space.reading.fields import NotDrawnError, field
from space.reading.grids import grid_cells
from tui.panels.map.viewport import Extent

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

FARTHEST_M = 1e6
"""A pose farther away than this is not valid."""
OCCUPIED_FROM = 50
"""The threshold of 100, in a nav_msgs/OccupancyGrid."""


@dataclass(frozen=True, eq=False)
class OccupancyGrid:
    """The map of a room; each message creates a new one."""

    cells: NDArray[np.int8]
    """Shape (rows, columns): -1 unknown, 0 free, 100 occupied."""
    cell_m: float
    origin: Pose
    """Position of the corner of the first cell, and the rotation of the rows."""
    frame: str
    extent: Extent | None
    """The known part, None if nothing is known."""

    def centres(
        self, rows: NDArray[np.float64], columns: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Positions of cells, x and y in metres."""
        along, up = (columns + 0.5) * self.cell_m, (rows + 0.5) * self.cell_m
        cos, sin = math.cos(self.origin.heading_rad), math.sin(self.origin.heading_rad)
        return self.origin.x_m + cos * along - sin * up, self.origin.y_m + sin * along + cos * up

    def occupied_at(self, x_m: NDArray[np.float64], y_m: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Whether there is an obstacle at these positions; outside there is none."""
        east, north = x_m - self.origin.x_m, y_m - self.origin.y_m
        cos, sin = math.cos(self.origin.heading_rad), math.sin(self.origin.heading_rad)
        columns = np.floor((cos * east + sin * north) / self.cell_m)
        rows = np.floor((cos * north - sin * east) / self.cell_m)
        high, wide = self.cells.shape
        inside = (rows >= 0) & (rows < high) & (columns >= 0) & (columns < wide)
        found = np.zeros(x_m.shape, dtype=np.bool_)
        at = rows[inside].astype(np.intp), columns[inside].astype(np.intp)
        found[inside] = self.cells[at] >= OCCUPIED_FROM
        return found


def pose_in(value: Mapping[str, Any]) -> tuple[Pose, str] | None:
    """Read an Odometry or a PoseStamped: pose and frame; None if the position is not valid."""
    try:
        inner = value["pose"]
        inner = inner.get("pose", inner)
        place, turn = inner["position"], inner["orientation"]
        heading = yaw_from_quaternion(*(float(turn[axis]) for axis in "xyzw"))
        pose = Pose(float(place["x"]), float(place["y"]), heading)
        frame = str(value["header"]["frame_id"])
    except (KeyError, TypeError, ValueError, AttributeError):
        return None
    near = pose.is_finite and max(abs(pose.x_m), abs(pose.y_m)) <= FARTHEST_M
    return (pose, frame) if near else None


def goal_in(value: Mapping[str, Any]) -> Point | None:
    """Read a PoseStamped with a goal; None if there is no goal any more."""
    found = pose_in(value)
    if found is None or not found[1]:
        return None
    return Point(found[0].x_m, found[0].y_m)


def occupancy_in(value: Mapping[str, Any]) -> OccupancyGrid | None:
    """Read an OccupancyGrid; None for an invalid one."""
    try:
        found, frame = grid_cells(value), str(field(value, "header.frame_id"))
    except NotDrawnError:
        return None
    x_m, y_m, _ = found.origin.translation
    origin = Pose(x_m, y_m, yaw_from_quaternion(*found.origin.rotation))
    occupancy = OccupancyGrid(found.cells, found.cell_m, origin, frame, None)
    return replace(occupancy, extent=_known(occupancy))


def _known(occupancy: OccupancyGrid) -> Extent | None:
    known = occupancy.cells >= 0
    rows, columns = np.flatnonzero(known.any(axis=1)), np.flatnonzero(known.any(axis=0))
    if not rows.size:
        return None
    # Half a cell on each side: the outer edges of the outermost cells.
    x, y = occupancy.centres(
        np.array([rows[0] - 0.5, rows[0] - 0.5, rows[-1] + 0.5, rows[-1] + 0.5]),
        np.array([columns[0] - 0.5, columns[-1] + 0.5, columns[0] - 0.5, columns[-1] + 0.5]),
    )
    return Extent(float(x.min()), float(x.max()), float(y.min()), float(y.max()))

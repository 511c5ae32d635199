"""The room of the simulated robot as the message that a mapping node would publish."""

from __future__ import annotations

import array
from typing import TYPE_CHECKING

from nav_msgs.msg import OccupancyGrid

if TYPE_CHECKING:
    from builtin_interfaces.msg import Time

    from robot.world.grid import CellMap

FRAME = "odom"
"""The simulated robot starts at the origin of its odometry, so one frame is enough."""


def occupancy_grid(grid: CellMap, stamp: Time) -> OccupancyGrid:
    """Put a grid into a message with this stamp."""
    message = OccupancyGrid()
    message.header.frame_id = FRAME
    message.header.stamp = message.info.map_load_time = stamp
    message.info.resolution = grid.cell_m
    message.info.height, message.info.width = grid.cells.shape
    message.info.origin.position.x = grid.x_m
    message.info.origin.position.y = grid.y_m
    message.info.origin.orientation.w = 1.0
    message.data = array.array("b", grid.cells.tobytes())
    return message

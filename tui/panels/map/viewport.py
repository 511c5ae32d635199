"""Which part of the floor is shown, and where a point of it is on the canvas.

Seen from above as on paper: x to the right and y upwards, so that a left turn appears as a left
turn. A metre has the same length in both directions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tui.panels.dots import Point


@dataclass(frozen=True)
class Extent:
    """A rectangle of the floor, in metres."""

    left_m: float
    right_m: float
    bottom_m: float
    top_m: float

    def holding(self, *places: Point) -> Extent:
        """Extend it to include these points."""
        across, up = [x for x, _y in places], [y for _x, y in places]
        return Extent(
            min([self.left_m, *across]),
            max([self.right_m, *across]),
            min([self.bottom_m, *up]),
            max([self.top_m, *up]),
        )

    def joined(self, other: Extent) -> Extent:
        """Extend it to include both."""
        return self.holding((other.left_m, other.bottom_m), (other.right_m, other.top_m))

    def widened(self, margin_m: float) -> Extent:
        return Extent(
            self.left_m - margin_m, self.right_m + margin_m, self.bottom_m - margin_m, self.top_m + margin_m
        )

    def rounded(self) -> Extent:
        """Round outwards to steps of about a tenth of it: the view must not move with the robot."""
        width_m, height_m = self.right_m - self.left_m, self.top_m - self.bottom_m
        step_m = 10.0 ** math.floor(math.log10(max(width_m, height_m, 1.0)))
        return Extent(
            math.floor(self.left_m / step_m) * step_m,
            math.ceil(self.right_m / step_m) * step_m,
            math.floor(self.bottom_m / step_m) * step_m,
            math.ceil(self.top_m / step_m) * step_m,
        )


@dataclass(frozen=True)
class Viewport:
    """An extent in the middle of a canvas with this many dots."""

    left_m: float
    top_m: float
    """Coordinates of the upper left corner of the first dot."""
    dots_per_m: float
    columns: int
    rows: int
    """In cells."""

    def place(self, x_m: float, y_m: float) -> Point:
        """The position of a point of the floor, in dots."""
        return (x_m - self.left_m) * self.dots_per_m, (self.top_m - y_m) * self.dots_per_m


def fitted(extent: Extent, columns: int, rows: int) -> Viewport:
    """Show all of an extent as large as possible in this many cells."""
    width_m = max(1e-6, extent.right_m - extent.left_m)
    height_m = max(1e-6, extent.top_m - extent.bottom_m)
    # Points on the edge are drawn in the outermost dot.
    scale = min((2 * columns - 1) / width_m, (4 * rows - 1) / height_m)
    return Viewport(
        (extent.left_m + extent.right_m) / 2 - columns / scale,
        (extent.bottom_m + extent.top_m) / 2 + 2 * rows / scale,
        scale,
        columns,
        rows,
    )

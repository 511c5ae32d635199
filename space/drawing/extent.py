"""The box that holds shapes, to fit the picture to them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from space.drawing.paints import Tint
from space.drawing.shapes import Faces, Floor, Sign, Speckles, Strokes

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from space.drawing.shapes import Shape
    from space.transform import Vector

OUTLIERS = 0.5
"""Percent of a cloud's points at each end that do not count."""
SAMPLED = 20_000


@dataclass(frozen=True)
class SpaceBox:
    """A box along the axes, in metres."""

    least: Vector
    most: Vector

    def holds(self, other: SpaceBox) -> bool:
        """Return whether another box is inside."""
        return all(a <= b for a, b in zip(self.least, other.least, strict=True)) and all(
            a >= b for a, b in zip(self.most, other.most, strict=True)
        )

    @property
    def size_m(self) -> float:
        return max(b - a for a, b in zip(self.least, self.most, strict=True))

    def widened(self, share: float, least_m: float) -> SpaceBox:
        """Return it larger by a share of its size at each side, and at least this wide."""
        margin = max(share * self.size_m, (least_m - self.size_m) / 2)
        low, high = self.least, self.most
        return SpaceBox(
            (low[0] - margin, low[1] - margin, low[2] - margin),
            (high[0] + margin, high[1] + margin, high[2] + margin),
        )


def extent_of(shapes: Iterable[Shape]) -> SpaceBox | None:
    """Return the box around shapes, None if there are none.

    Muted ones do not count: they show where nothing was found.
    """
    found = [corners for shape in shapes if len(corners := _corners(shape))]
    if not found:
        return None
    whole = np.concatenate(found)
    low, high = whole.min(axis=0).tolist(), whole.max(axis=0).tolist()
    return SpaceBox((low[0], low[1], low[2]), (high[0], high[1], high[2]))


def _corners(shape: Shape) -> NDArray[np.float32]:
    if isinstance(shape, Speckles):
        return _cloud_corners(shape)
    if isinstance(shape, Strokes):
        if not isinstance(shape.paint, np.ndarray) and shape.paint == Tint.MUTED:
            return shape.starts[:0]
        return np.concatenate([shape.starts, shape.ends])
    if isinstance(shape, Faces):
        return shape.corners.reshape(-1, 3)
    if isinstance(shape, Sign):
        return np.array([shape.place], dtype=np.float32)
    return _floor_corners(shape)


def _cloud_corners(shape: Speckles) -> NDArray[np.float32]:
    points = shape.places[:: max(1, len(shape.places) // SAMPLED)]
    if not len(points):
        return points
    ends = [OUTLIERS, 100 - OUTLIERS] if len(points) > SAMPLED // 10 else [0, 100]
    corners: NDArray[np.float32] = np.percentile(points, ends, axis=0).astype(np.float32)
    return corners


def _floor_corners(shape: Floor) -> NDArray[np.float32]:
    known = shape.cells > 0
    rows, columns = np.flatnonzero(known.any(axis=1)), np.flatnonzero(known.any(axis=0))
    if not rows.size:
        return np.zeros((0, 3), dtype=np.float32)
    across, up = (columns[0], columns[-1] + 1), (rows[0], rows[-1] + 1)
    corners = np.array([[x, y, 0] for x in across for y in up], dtype=np.float32)
    return shape.origin.points(corners * np.float32(shape.cell_m)).astype(np.float32)

"""Fewer points that look the same: one for each cube of a grid.

A camera of depth sends hundreds of thousands of points, and a terminal has some ten thousand dots.
Points in the middles of fixed cubes also stay where they are while their sensor's noise moves them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from space.drawing.shapes import Speckles

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from space.drawing.paints import Paints
    from space.drawing.shapes import Places

MOST_CUBES = 4_000_000
"""Bytes of memory for a grid; for a larger scene the cubes are larger."""
FEW = 2_000
"""So few points are not worth it."""


def thinned(points: Speckles, cube_m: float) -> Speckles:
    """Return one point for each cube of this size in which there are any."""
    places = points.places
    if len(places) <= FEW or not cube_m > 0:
        return points
    least, most = _corners(places)
    size = max(cube_m, float(np.max(most - least)) / 1e6)
    while np.prod(np.ceil((most - least) / size) + 2) > MOST_CUBES:
        size *= 2
    # Cubes begin at multiples of their size: they do not move with the outermost point.
    origin = np.floor(least / size)
    shape = (np.floor(most / size) - origin).astype(np.int64) + 2
    at = np.zeros(len(places), dtype=np.int32)
    for axis in range(3):
        at *= np.int32(shape[axis])
        # Nothing is below the origin, so that cutting off is rounding down.
        scaled = places[:, axis] * np.float32(1.0 / size) - np.float32(origin[axis])
        at += scaled.astype(np.int32)
    kept, paint = _in_cubes(at, points.paint, int(np.prod(shape)))
    middles = np.empty((3, len(kept)), dtype=np.float32)
    rest = kept.astype(np.int32)
    for axis in (2, 1, 0):
        rest, place = np.divmod(rest, np.int32(shape[axis]))
        middles[axis] = (place + np.float32(origin[axis] + 0.5)) * np.float32(size)
    return Speckles(middles.T, paint, points.solid_m)


def _corners(places: Places) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The least and the most of each axis, axis by axis: all at once takes numpy longer."""
    least = np.array([places[:, axis].min() for axis in range(3)], dtype=np.float64)
    most = np.array([places[:, axis].max() for axis in range(3)], dtype=np.float64)
    return least, most


def _in_cubes(at: NDArray[np.int32], paint: int | Paints, total: int) -> tuple[NDArray[np.int64], int | Paints]:
    """Return which cubes have points, and the paint of the last point in each."""
    there = np.zeros(total, dtype=np.bool_)
    there[at] = True
    kept = np.flatnonzero(there)
    if not isinstance(paint, np.ndarray):
        return kept, paint
    table = np.zeros(total, dtype=np.uint8)
    table[at] = paint
    return kept, table[kept]

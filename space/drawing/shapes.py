"""What is drawn: points, strokes, signs and floors, in metres of one frame.

Arrays of places are float32, of shape (n, 3). A shape has one paint for all of it, or one for each
point or stroke. What is solid is drawn by its edges.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from space.drawing.paints import Paints, Tint
from space.transform import IDENTITY, Transform

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from space.transform import Vector

Places: TypeAlias = "NDArray[np.float32]"


@dataclass(frozen=True, eq=False)
class Speckles:
    """Points, each as small as can be drawn."""

    places: Places
    paint: int | Paints = Tint.TEXT
    solid_m: float = 0.0
    """The edge of the cubes that the points stand for; 0 for mere points."""


@dataclass(frozen=True, eq=False)
class Strokes:
    """Straight lines between two lists of points."""

    starts: Places
    ends: Places
    paint: int | Paints = Tint.TEXT


@dataclass(frozen=True)
class Sign:
    """A text beside a place."""

    place: Vector
    text: str
    paint: int = Tint.TEXT


@dataclass(frozen=True, eq=False)
class Floor:
    """A plane of square cells: the first at the origin, rows along y, columns along x."""

    cells: Paints
    """Shape (rows, columns)."""
    cell_m: float
    origin: Transform = IDENTITY


Shape: TypeAlias = Speckles | Strokes | Sign | Floor


def places(*points: Vector) -> Places:
    """Return points as an array."""
    return np.array(points, dtype=np.float32).reshape(-1, 3)


def moved(shape: Shape, by: Transform) -> Shape:
    """Return a shape, which is given in a child frame, in the parent."""
    if isinstance(shape, Speckles):
        return Speckles(_points(by, shape.places), shape.paint, shape.solid_m)
    if isinstance(shape, Strokes):
        return Strokes(_points(by, shape.starts), _points(by, shape.ends), shape.paint)
    if isinstance(shape, Sign):
        return Sign(by.point(shape.place), shape.text, shape.paint)
    return Floor(shape.cells, shape.cell_m, by @ shape.origin)


def _points(by: Transform, points: NDArray[np.floating]) -> Places:
    return by.points(points).astype(np.float32, copy=False)


def polyline(points: Places, paint: int | Paints = Tint.TEXT) -> Strokes:
    """Return the line from point to point."""
    return Strokes(points[:-1], points[1:], paint)


def axes(at: Transform, length_m: float) -> tuple[Strokes, ...]:
    """Return the axes of a frame: x red, y green, z blue."""
    tips = ((Tint.X_AXIS, (length_m, 0.0, 0.0)), (Tint.Y_AXIS, (0.0, length_m, 0.0)), (Tint.Z_AXIS, (0, 0, length_m)))
    return tuple(Strokes(places(at.translation), places(at.point(tip)), paint) for paint, tip in tips)


def arrow(at: Transform, length_m: float, paint: int) -> Strokes:
    """Return an arrow along x."""
    back, wide, tip = 0.72 * length_m, 0.16 * length_m, (length_m, 0.0, 0.0)
    starts = places((0.0, 0.0, 0.0), (back, wide, 0.0), (back, -wide, 0.0))
    return Strokes(_points(at, starts), _points(at, places(tip, tip, tip)), paint)


def dart(at: Transform, length_m: float, paint: int) -> Strokes:
    """Return an arrowhead about a place, that points along x."""
    corners = places((1, 0, 0), (-0.9, 0.75, 0), (-0.45, 0, 0), (-0.9, -0.75, 0), (1, 0, 0))
    return polyline(_points(at, corners * np.float32(length_m / 2)), paint)


_SIDES = np.array([(x, y, z) for z in (-1, 1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1))], np.float32)
"""Below and above, each round about a box from -1 to 1."""
_TURN = np.linspace(0, 2 * np.pi, 17, dtype=np.float32)
_UP = np.array([0, 0, 1], dtype=np.float32)
_RING = np.stack([np.cos(_TURN), np.sin(_TURN), np.zeros_like(_TURN)], axis=1)


def box(at: Transform, size_m: Vector, paint: int) -> tuple[Shape, ...]:
    """Return a box about its middle."""
    return (_solid(at, size_m, (_SIDES[:5], _SIDES[5:]), paint),)


def cylinder(at: Transform, size_m: Vector, paint: int) -> tuple[Shape, ...]:
    """Return a cylinder about z: x and y of its size are the diameters, z the height."""
    return (_solid(at, size_m, (_RING - _UP, _RING + _UP), paint),)


def ellipsoid(at: Transform, size_m: Vector, paint: int) -> tuple[Shape, ...]:
    """Return a sphere, or what becomes of it if its three diameters differ."""
    return (_solid(at, size_m, (_RING, _RING[:, [2, 0, 1]], _RING[:, [1, 2, 0]]), paint),)


def _solid(at: Transform, size_m: Vector, rings: tuple[NDArray[np.floating], ...], paint: int) -> Strokes:
    """Return rings of a shape from -1 to 1, and what joins those that lie over each other."""
    size = np.array(size_m, dtype=np.float32) / 2
    placed = [_points(at, (ring * size).astype(np.float32)) for ring in rings]
    starts, ends = [ring[:-1] for ring in placed], [ring[1:] for ring in placed]
    if len(placed) == 2:
        step = (len(placed[0]) - 1) // 4
        starts.append(placed[0][:-1:step])
        ends.append(placed[1][:-1:step])
    return Strokes(np.concatenate(starts), np.concatenate(ends), paint)

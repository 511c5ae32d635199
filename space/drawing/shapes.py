"""What is drawn: points, strokes, faces, signs and floors, in metres of one frame.

Arrays of places are float32, of shape (n, 3). A shape has one paint for all of it, or one for each
point, stroke or face.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from space.drawing.paints import Paints, Tint, cube, rgb_of
from space.transform import IDENTITY, Transform

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from space.transform import Vector

Places: TypeAlias = "NDArray[np.float32]"


LIGHT = np.array([0.05, -0.45, 0.89], dtype=np.float32)
"""From where it comes: from above, and a little from the right of what looks along x."""
SHADE = 0.45
"""How bright a face is that it does not reach."""


DARKEST = 60
"""How bright what is black is drawn, of 255: the background is black as well."""


@dataclass(frozen=True, eq=False)
class Speckles:
    """Points, each as small as can be drawn."""

    places: Places
    paint: int | Paints = Tint.TEXT
    solid_m: float = 0.0
    """The edge of the cubes that the points stand for; 0 for mere points."""


@dataclass(frozen=True, eq=False)
class Strokes:
    """Straight lines between two lists of points, in metres in the frame of the drawing."""

    starts: Places
    ends: Places
    paint: int | Paints = Tint.TEXT


@dataclass(frozen=True, eq=False)
class Faces:
    """Filled triangles, of shape (n, 3, 3): triangle, corner, axis."""

    corners: Places
    paint: int | Paints = Tint.TEXT


@dataclass(frozen=True)
class Sign:
    """A text beside a place."""

    place: Vector
    text: str
    paint: int = Tint.TEXT
    name: str = ""
    """By what it is known in the next picture, so that it stays in its row; with none it is not."""


@dataclass(frozen=True, eq=False)
class Floor:
    """A plane of square cells: the first at the origin, rows along y, columns along x."""

    cells: Paints
    """Shape (rows, columns)."""
    cell_m: float
    origin: Transform = IDENTITY


Shape: TypeAlias = Speckles | Strokes | Faces | Sign | Floor


def places(*points: Vector) -> Places:
    """Return points as an array."""
    return np.array(points, dtype=np.float32).reshape(-1, 3)


def moved(shape: Shape, by: Transform) -> Shape:
    """Return a shape, which is given in a child frame, in the parent."""
    if isinstance(shape, Speckles):
        return Speckles(_points(by, shape.places), shape.paint, shape.solid_m)
    if isinstance(shape, Strokes):
        return Strokes(_points(by, shape.starts), _points(by, shape.ends), shape.paint)
    if isinstance(shape, Faces):
        flat = _points(by, shape.corners.reshape(-1, 3))
        return Faces(flat.reshape(-1, 3, 3), shape.paint)
    if isinstance(shape, Sign):
        return Sign(by.point(shape.place), shape.text, shape.paint, shape.name)
    return Floor(shape.cells, shape.cell_m, by @ shape.origin)


def _points(by: Transform, points: NDArray[np.floating]) -> Places:
    return by.points(points).astype(np.float32, copy=False)


def polyline(points: Places, paint: int | Paints = Tint.TEXT) -> Strokes:
    """Return the line from point to point."""
    return Strokes(points[:-1], points[1:], paint)


def axes(at: Transform, length_m: float) -> tuple[Strokes, ...]:
    """Return the axes of a frame: x red, y green, z blue."""
    origin = places(at.translation)
    return tuple(
        Strokes(origin, places(at.point(tip)), paint)
        for tip, paint in (
            ((length_m, 0.0, 0.0), Tint.X_AXIS),
            ((0.0, length_m, 0.0), Tint.Y_AXIS),
            ((0.0, 0.0, length_m), Tint.Z_AXIS),
        )
    )


def arrow(at: Transform, length_m: float, paint: int) -> Strokes:
    """Return an arrow along x, with a head that is seen from above and from the side."""
    back, wide = 0.72 * length_m, 0.16 * length_m
    tip = (length_m, 0.0, 0.0)
    wings = ((back, wide, 0.0), (back, -wide, 0.0), (back, 0.0, wide), (back, 0.0, -wide))
    starts = places((0.0, 0.0, 0.0), *wings)
    return Strokes(_points(at, starts), _points(at, places(*[tip] * len(starts))), paint)


def dart(at: Transform, length_m: float, paint: int) -> Faces:
    """Return a flat arrowhead about a place, filled, that points along x."""
    nose, left, notch, right = (
        (ahead * length_m / 2, aside * length_m / 2, 0.0)
        for ahead, aside in ((1.0, 0.0), (-0.9, 0.75), (-0.45, 0.0), (-0.9, -0.75))
    )
    halves = _points(at, places(nose, left, notch, nose, notch, right))
    return Faces(halves.reshape(2, 3, 3), paint)


def box(at: Transform, size_m: Vector, paint: int) -> tuple[Shape, ...]:
    """Return a box about its middle."""
    size = np.array(size_m, dtype=np.float32)
    return (_solid(at, (_CORNERS * size / 2)[_SIDES], paint),)


def ellipsoid(at: Transform, size_m: Vector, paint: int) -> tuple[Shape, ...]:
    """Return a sphere, or what becomes of it if its three diameters differ."""
    return (_solid(at, _unit_sphere() * (np.array(size_m, dtype=np.float32) / 2), paint),)


def cylinder(at: Transform, size_m: Vector, paint: int) -> tuple[Shape, ...]:
    """Return a cylinder about z: x and y of its size are the diameters, z the height."""
    return (_solid(at, _unit_cylinder() * (np.array(size_m, dtype=np.float32) / 2), paint),)


def _solid(at: Transform, corners: NDArray[np.floating], paint: int) -> Faces:
    """Place the faces of a convex shape about the origin, each as bright as the light makes it."""
    placed = _points(at, corners.reshape(-1, 3)).reshape(-1, 3, 3)
    rgb = rgb_of(paint)
    if rgb is None:
        return Faces(placed, paint)
    normals = np.cross(placed[:, 1] - placed[:, 0], placed[:, 2] - placed[:, 0])
    outwards = placed.mean(axis=1) - np.array(at.translation, dtype=np.float32)
    normals *= np.sign((normals * outwards).sum(axis=1))[:, None]
    lengths = np.linalg.norm(normals, axis=1)
    lit = (normals @ LIGHT) / np.where(lengths > 0, lengths, 1.0)
    bright = SHADE + (1 - SHADE) * np.clip(lit, 0.0, 1.0)
    lifted = DARKEST + np.array(rgb) * (1 - DARKEST / 255)
    return Faces(placed, cube((lifted * bright[:, None]).astype(np.uint8)))


_CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=np.float32)
_SIDES = np.array(
    [
        [a, b, c]
        for quad in ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
        for a, b, c in ((quad[0], quad[1], quad[2]), (quad[0], quad[2], quad[3]))
    ]
)
_ROUND = 16
"""Corners of a circle."""


@lru_cache(maxsize=1)
def _unit_cylinder() -> Places:
    """Faces of a cylinder of radius 1 and height 2."""
    turn = np.linspace(0, 2 * np.pi, _ROUND + 1)
    ring = np.stack([np.cos(turn), np.sin(turn), np.ones_like(turn)], axis=1)
    low = ring * (1, 1, -1)
    faces = []
    for a, b, c, d in zip(ring[:-1], ring[1:], low[:-1], low[1:], strict=True):
        faces += [(a, b, c), (b, d, c), (a, b, (0, 0, 1)), (c, d, (0, 0, -1))]
    return np.array(faces, dtype=np.float32)


@lru_cache(maxsize=1)
def _unit_sphere() -> Places:
    """Faces of a sphere of radius 1."""
    turn = np.linspace(0, 2 * np.pi, _ROUND + 1)
    rise = np.linspace(-np.pi / 2, np.pi / 2, _ROUND // 2 + 1)
    grid = np.stack(
        [
            np.outer(np.cos(rise), np.cos(turn)),
            np.outer(np.cos(rise), np.sin(turn)),
            np.outer(np.sin(rise), np.ones_like(turn)),
        ],
        axis=2,
    )
    a, b, c, d = grid[:-1, :-1], grid[:-1, 1:], grid[1:, :-1], grid[1:, 1:]
    faces = np.concatenate([np.stack([a, b, c], axis=2), np.stack([b, d, c], axis=2)])
    return faces.reshape(-1, 3, 3).astype(np.float32)

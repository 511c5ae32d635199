"""Shapes, seen by a camera, on a raster."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from space.drawing.camera import NEAREST_M
from space.drawing.paints import Tint
from space.drawing.shapes import Faces, Floor, Shape, Sign, Speckles, Strokes
from space.transform import turned

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from space.drawing.camera import SpaceCamera
    from space.drawing.paints import Paints
    from space.drawing.raster import Raster

FAR_M = 1e6
"""The far end of what a floor can be seen."""
MOST_BLOCK_DOTS = 12
"""How many dots wide a cell of an obstacle may appear; a larger one is cut to that."""


def draw(raster: Raster, camera: SpaceCamera, shapes: Iterable[Shape]) -> None:
    """Draw all; all strokes at once, as all faces: a robot has dozens, and each costs a little."""
    shapes = list(shapes)
    for shape in shapes:
        if isinstance(shape, Floor):
            _draw_floor(shape, raster, camera)
        elif isinstance(shape, Speckles):
            _draw_speckles(shape, raster, camera)
    faces = [shape for shape in shapes if isinstance(shape, Faces) and len(shape.corners)]
    if faces:
        corners = np.concatenate([one.corners for one in faces])
        _draw_faces(Faces(corners, _paints([(len(f.corners), f.paint) for f in faces])), raster, camera)
    strokes = [shape for shape in shapes if isinstance(shape, Strokes) and len(shape.starts)]
    if strokes:
        starts = np.concatenate([one.starts for one in strokes])
        ends = np.concatenate([one.ends for one in strokes])
        paints = _paints([(len(one.starts), one.paint) for one in strokes])
        _draw_strokes(Strokes(starts, ends, paints), raster, camera)
    for shape in shapes:
        if isinstance(shape, Sign):
            # Last, since it is written over the rest.
            _draw_sign(shape, raster, camera)


def _paints(counted: list[tuple[int, int | Paints]]) -> Paints:
    parts = [np.broadcast_to(np.asarray(paint, dtype=np.uint8), count) for count, paint in counted]
    paints: Paints = np.concatenate(parts)
    return paints


def _draw_speckles(shape: Speckles, raster: Raster, camera: SpaceCamera) -> None:
    spots = camera.project(shape.places, raster.width, raster.height)
    raster.dots(spots, shape.paint)
    wide = int(min(MOST_BLOCK_DOTS, shape.solid_m * camera.dots_per_m))
    if wide < 2 or camera.turns:
        return
    for right in range(wide):
        for down in range(wide):
            moved = spots + np.array([right - wide / 2, down - wide / 2, 0], dtype=np.float32)
            raster.dots(moved, shape.paint)


def _draw_strokes(shape: Strokes, raster: Raster, camera: SpaceCamera) -> None:
    starts, ends = camera.seen(shape.starts, raster.height), camera.seen(shape.ends, raster.height)
    if camera.turns:
        starts, ends = _before_the_eye(starts, ends), _before_the_eye(ends, starts)
    raster.strokes(
        camera.on_picture(starts, raster.width, raster.height),
        camera.on_picture(ends, raster.width, raster.height),
        shape.paint,
    )


def _before_the_eye(ends: NDArray[np.float32], others: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return the ends, moved along their lines to where the eye begins to see.

    Lines that are wholly behind it become NaN.
    """
    least = np.float32(2 * NEAREST_M)
    behind = ends[:, 2] < least
    if not behind.any():
        return ends
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (least - ends[:, 2]) / (others[:, 2] - ends[:, 2])
    cut = ends + (others - ends) * share[:, None]
    cut[others[:, 2] < least] = np.nan
    return np.where(behind[:, None], cut, ends)


def _draw_faces(shape: Faces, raster: Raster, camera: SpaceCamera) -> None:
    spots = camera.project(shape.corners.reshape(-1, 3), raster.width, raster.height)
    raster.faces(spots.reshape(-1, 3, 3), shape.paint)


def _draw_floor(shape: Floor, raster: Raster, camera: SpaceCamera) -> None:
    """Tint the floor behind everything, and what stands on it as dots, so that none is missed."""
    x, y = np.meshgrid(np.arange(raster.width) + 0.5, np.arange(raster.height) + 0.5)
    begins, directions = camera.rays(x.ravel(), y.ravel(), raster.width, raster.height)
    back = shape.origin.inverse()
    matrix = back.matrix()[:3, :3]
    starts, ways = turned(begins, matrix, back.translation), turned(directions, matrix)
    with np.errstate(divide="ignore", invalid="ignore"):
        way = -starts[:, 2] / ways[:, 2]
        column = (starts[:, 0] + way * ways[:, 0]) / shape.cell_m
        row = (starts[:, 1] + way * ways[:, 1]) / shape.cell_m
        high, wide = shape.cells.shape
        inside = (column >= 0) & (column < wide) & (row >= 0) & (row < high)
        if camera.turns:
            inside &= (way > 0) & (way < FAR_M)
    met = np.flatnonzero(inside)
    paints = np.zeros(len(way), dtype=np.uint8)
    paints[met] = shape.cells[row[met].astype(np.intp), column[met].astype(np.intp)]
    # Of the four dots of half a cell the most occupied one counts: walls are thin.
    halves = paints.reshape(2 * raster.rows, 2, raster.columns, 2).max(axis=(1, 3))
    np.copyto(raster.floor, halves, where=halves > 0)
    if shape.cell_m * camera.dots_per_m < 1:
        _draw_speckles(_standing(shape), raster, camera)


def _standing(shape: Floor) -> Speckles:
    rows, columns = np.nonzero(shape.cells == Tint.WALL)
    middles = np.stack([columns + 0.5, rows + 0.5, np.zeros(len(rows))], axis=1) * shape.cell_m
    return Speckles(shape.origin.points(middles).astype(np.float32), Tint.WALL)


def _draw_sign(sign: Sign, raster: Raster, camera: SpaceCamera) -> None:
    place = np.array([sign.place], dtype=np.float32)
    x, y, _depth = camera.project(place, raster.width, raster.height)[0]
    # A cell to the right, so that the place itself stays visible.
    raster.sign(float(x) + 3, float(y), sign.text, sign.paint, sign.name)

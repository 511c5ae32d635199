"""Shapes seen from above, as characters of a terminal: x to the right and y upwards, as on a map.

A dot is the finest unit: there are two by four in a cell, which are about square.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from space.drawing.braille import BLANK, DOTS_ACROSS, DOTS_DOWN, characters
from space.drawing.paints import Paints, Tint
from space.drawing.shapes import Floor, Shape, Sign, Speckles, Strokes

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    Spots = NDArray[np.floating]
    """Where dots are: x to the right and y downwards, of shape (n, 2)."""

LEAST_DOTS_PER_M, MOST_DOTS_PER_M = 0.01, 20_000.0
FIT_EDGE_DOTS = 2
"""What is fitted stays this far from the edges."""
OUTLIERS = 0.5
"""Percent of a cloud's points at each end that do not count when the picture is fitted to it."""
MANY = 2_000
"""A cloud of fewer points has no outliers."""
MOST_STEPS = 400_000
"""Dots of all strokes of one shape; with more, their dots are farther apart."""
MOST_BLOCK_DOTS = 12
"""How many dots wide a cube may appear; a larger one is cut to that."""
SIGN_DOTS = 3
"""A text begins a cell to the right of its place, so that the place itself stays visible."""
NEAR_COLUMNS = 6
"""By how many cells it makes way for what is drawn there, such as the robot itself."""
NEAR_ROWS = (0, 1, -1, 2, -2)
"""By how many rows a text may be away from its place, if another one is there."""


@dataclass(frozen=True)
class SpaceBox:
    """A rectangle along the axes, in metres."""

    left_m: float
    bottom_m: float
    right_m: float
    top_m: float

    def holds(self, other: SpaceBox) -> bool:
        return (
            self.left_m <= other.left_m
            and self.bottom_m <= other.bottom_m
            and self.right_m >= other.right_m
            and self.top_m >= other.top_m
        )

    def widened(self, share: float, least_m: float) -> SpaceBox:
        """Return it larger by a share of its size at each side, and at least this wide."""
        size = max(self.right_m - self.left_m, self.top_m - self.bottom_m)
        margin = max(share * size, (least_m - size) / 2)
        return SpaceBox(self.left_m - margin, self.bottom_m - margin, self.right_m + margin, self.top_m + margin)


@dataclass(frozen=True)
class SpaceCamera:
    """Which part of the floor is seen, in a picture of some width and height in dots."""

    x_m: float = 0.0
    y_m: float = 0.0
    """What is in the middle of the picture."""
    dots_per_m: float = 40.0

    def spots(self, points: NDArray[np.floating], width: int, height: int) -> Spots:
        """Return where points are in the picture."""
        middle = np.array([self.x_m, self.y_m])
        scale = np.array([self.dots_per_m, -self.dots_per_m])
        spots: Spots = (points[:, :2] - middle) * scale + np.array([width / 2, height / 2])
        return spots

    def floor_at(self, x: float, y: float, width: int, height: int) -> tuple[float, float]:
        """Return the place below a spot, in metres."""
        return self.x_m + (x - width / 2) / self.dots_per_m, self.y_m - (y - height / 2) / self.dots_per_m

    def panned(self, right: float, down: float) -> SpaceCamera:
        """Return the camera after the picture was moved by this many dots."""
        return replace(self, x_m=self.x_m - right / self.dots_per_m, y_m=self.y_m + down / self.dots_per_m)

    def zoomed(self, factor: float, right: float = 0.0, down: float = 0.0) -> SpaceCamera:
        """Return the camera `factor` times closer.

        What is `right` and `down` of the middle, in dots, stays there.
        """
        scale = min(max(self.dots_per_m * factor, LEAST_DOTS_PER_M), MOST_DOTS_PER_M)
        gone = 1 - self.dots_per_m / scale
        return replace(self.panned(-right * gone, -down * gone), dots_per_m=scale)

    def fitting(self, box: SpaceBox, width: int, height: int) -> SpaceCamera:
        """Return the camera that shows all of a box, as large as possible."""
        across, up = max(box.right_m - box.left_m, 1e-6), max(box.top_m - box.bottom_m, 1e-6)
        scale = min((width - 2 * FIT_EDGE_DOTS) / across, (height - 2 * FIT_EDGE_DOTS) / up)
        return SpaceCamera(
            (box.left_m + box.right_m) / 2,
            (box.bottom_m + box.top_m) / 2,
            min(max(scale, LEAST_DOTS_PER_M), MOST_DOTS_PER_M),
        )


def extent_of(shapes: Iterable[Shape]) -> SpaceBox | None:
    """Return the box around shapes, None if there are none.

    Muted ones do not count: they show where nothing was found.
    """
    found = [corners for shape in shapes if len(corners := _corners(shape))]
    if not found:
        return None
    whole = np.concatenate(found)
    return SpaceBox(*whole.min(axis=0).tolist(), *whole.max(axis=0).tolist())


def _corners(shape: Shape) -> NDArray[np.floating]:
    if isinstance(shape, Speckles) and len(shape.places):
        ends = [OUTLIERS, 100 - OUTLIERS] if len(shape.places) > MANY else [0, 100]
        return np.percentile(shape.places[:, :2], ends, axis=0)
    if isinstance(shape, Speckles):
        return shape.places[:, :2]
    if isinstance(shape, Strokes):
        muted = not isinstance(shape.paint, np.ndarray) and shape.paint == Tint.MUTED
        return np.concatenate([shape.starts, shape.ends])[: 0 if muted else None, :2]
    if isinstance(shape, Sign):
        return np.array([shape.place[:2]])
    return _floor_corners(shape)


def _floor_corners(shape: Floor) -> NDArray[np.floating]:
    known = shape.cells > 0
    rows, columns = np.flatnonzero(known.any(axis=1)), np.flatnonzero(known.any(axis=0))
    if not rows.size:
        return np.zeros((0, 2))
    across, up = (columns[0], columns[-1] + 1), (rows[0], rows[-1] + 1)
    corners = np.array([[x, y, 0.0] for x in across for y in up]) * shape.cell_m
    return shape.origin.points(corners)[:, :2]


@dataclass(frozen=True, eq=False)
class CellPicture:
    """Characters and paints of all cells, each of shape (rows, columns)."""

    codes: NDArray[np.uint16]
    front: Paints
    back: Paints

    def changed(self, before: CellPicture) -> NDArray[np.bool_]:
        """Return which cells differ from another picture of the same shape."""
        differ = (self.codes != before.codes) | (self.front != before.front) | (self.back != before.back)
        return np.asarray(differ)


def picture(camera: SpaceCamera, shapes: Iterable[Shape], columns: int, rows: int) -> CellPicture:
    """Draw shapes into this many cells: the floor below all, then points, lines, and texts over the rest."""
    canvas = _Canvas(camera, columns, rows)
    for shape in sorted(shapes, key=lambda shape: _ORDER.index(type(shape))):
        canvas.draw(shape)
    return canvas.cells()


_ORDER = (Floor, Speckles, Strokes, Sign)


class _Canvas:
    """Dots; a cell has the paint of what was drawn in it last."""

    def __init__(self, camera: SpaceCamera, columns: int, rows: int) -> None:
        self._camera, self._columns, self._rows = camera, columns, rows
        self._size = DOTS_ACROSS * columns, DOTS_DOWN * rows
        self._on = np.zeros((self._size[1], self._size[0]), dtype=np.bool_)
        self._front = np.zeros((rows, columns), dtype=np.uint8)
        self._back = np.zeros((rows, columns), dtype=np.uint8)
        self._signs: list[tuple[int, int, Sign]] = []
        """Texts with their row and first column."""

    def draw(self, shape: Shape) -> None:
        if isinstance(shape, Floor):
            self._floor(shape)
        elif isinstance(shape, Speckles):
            self._speckles(shape)
        elif isinstance(shape, Strokes):
            self._strokes(shape)
        else:
            self._sign(shape)

    def _floor(self, shape: Floor) -> None:
        """Tint the floor behind everything, and set what stands on it as dots, so that none is missed."""
        width, height = self._size
        x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
        x_m, y_m = self._camera.floor_at(x, y, width, height)
        places = np.stack([np.ravel(x_m), np.ravel(y_m), np.full(x.size, shape.origin.translation[2])], axis=1)
        column, row, _z = (shape.origin.inverse().points(places) / shape.cell_m).T
        high, wide = shape.cells.shape
        met = np.flatnonzero((column >= 0) & (column < wide) & (row >= 0) & (row < high))
        paints = np.zeros(x.size, dtype=np.uint8)
        paints[met] = shape.cells[row[met].astype(np.intp), column[met].astype(np.intp)]
        spots = np.stack([x.ravel(), y.ravel()], axis=1)
        walls = paints == Tint.WALL
        self._dots(spots[walls], Tint.WALL)
        ground = np.where(walls, np.uint8(0), paints).reshape(self._rows, DOTS_DOWN, self._columns, DOTS_ACROSS)
        ground = ground.max(axis=(1, 3))
        np.copyto(self._back, ground, where=ground > 0)
        if shape.cell_m * self._camera.dots_per_m < 1:
            rows, columns = np.nonzero(shape.cells == Tint.WALL)
            middles = np.stack([columns + 0.5, rows + 0.5, np.zeros(len(rows))], axis=1) * shape.cell_m
            self._dots(self._camera.spots(shape.origin.points(middles), *self._size), Tint.WALL)

    def _speckles(self, shape: Speckles) -> None:
        spots = self._camera.spots(shape.places, *self._size)
        wide = max(1, int(min(MOST_BLOCK_DOTS, shape.solid_m * self._camera.dots_per_m)))
        for right in range(wide):
            for down in range(wide):
                self._dots(spots + np.array([right - wide // 2, down - wide // 2]), shape.paint)

    def _strokes(self, shape: Strokes) -> None:
        starts = self._camera.spots(shape.starts, *self._size)
        ends = self._camera.spots(shape.ends, *self._size)
        first, last = self._inside(starts, ends)
        shown = first <= last
        starts, way = starts[shown], (ends - starts)[shown]
        starts, way = starts + way * first[shown, None], way * (last - first)[shown, None]
        if not len(starts):
            return
        steps = np.maximum(1, np.ceil(np.abs(way).max(axis=1))).astype(np.int64)
        if (total := int(steps.sum())) > MOST_STEPS:
            steps = np.maximum(1, steps * MOST_STEPS // total)
        which = np.repeat(np.arange(len(steps)), steps + 1)
        number = np.arange(len(which)) - np.repeat(np.cumsum(steps + 1) - (steps + 1), steps + 1)
        paint = shape.paint[shown][which] if isinstance(shape.paint, np.ndarray) else shape.paint
        self._dots(starts[which] + way[which] * (number / steps[which])[:, None], paint)

    def _inside(self, starts: Spots, ends: Spots) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return which part of each line is inside, as shares of its length (Liang-Barsky)."""
        first, last = np.zeros(len(starts)), np.ones(len(starts))
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            for axis, most in enumerate(self._size):
                begin, way = starts[:, axis], ends[:, axis] - starts[:, axis]
                one, other = -begin / way, (most - begin) / way
                outside = (begin < 0) | (begin > most)
                still = way == 0
                first = np.maximum(first, np.where(still, 0, np.minimum(one, other)))
                last = np.minimum(last, np.where(still, np.where(outside, -1, 1), np.maximum(one, other)))
        return first, last

    def _dots(self, spots: Spots, paint: int | Paints) -> None:
        """Set dots; those outside, and NaN, are ignored."""
        x, y = spots[:, 0], spots[:, 1]
        inside = np.flatnonzero((x >= 0) & (x < self._size[0]) & (y >= 0) & (y < self._size[1]))
        column, row = x[inside].astype(np.intp), y[inside].astype(np.intp)
        self._on[row, column] = True
        paints = paint[inside] if isinstance(paint, np.ndarray) else paint
        self._front[row // DOTS_DOWN, column // DOTS_ACROSS] = paints

    def _sign(self, shape: Sign) -> None:
        """Write a text, in a row close by if another one is in its own, or leave it out."""
        ((x, y),) = self._camera.spots(np.array([shape.place]), *self._size).tolist()
        x += SIGN_DOTS
        if not (0 <= x < self._size[0] and 0 <= y < self._size[1] and shape.text):
            return
        row, column = int(y) // DOTS_DOWN, int(x) // DOTS_ACROSS
        for own in (row + away for away in NEAR_ROWS if 0 <= row + away < self._rows):
            start = self._behind_the_drawn(own, column, len(shape.text))
            if not any(
                own == other and start <= begin + len(sign.text) and begin <= start + len(shape.text)
                for other, begin, sign in self._signs
            ):
                self._signs.append((own, start, shape))
                return

    def _behind_the_drawn(self, row: int, column: int, length: int) -> int:
        """Return where a text has room that would hide what is drawn from this column on, if that ends close by."""
        begin, near = DOTS_ACROSS * column, DOTS_ACROSS * (column + NEAR_COLUMNS + 1)
        _rows, drawn = np.nonzero(self._on[DOTS_DOWN * row : DOTS_DOWN * (row + 1), begin:near])
        end = column + int(drawn.max()) // DOTS_ACROSS + 1 if drawn.size else column
        return column if end > min(column + NEAR_COLUMNS, self._columns - length) else end

    def cells(self) -> CellPicture:
        codes = characters(self._on)
        front = np.where(codes == BLANK, np.uint8(0), self._front)
        for row, column, sign in self._signs:
            for place, char in enumerate(sign.text[: self._columns - column], column):
                codes[row, place], front[row, place] = ord(char), sign.paint
        return CellPicture(codes, front, self._back)

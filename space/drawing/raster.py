"""Dots with depth and paint, and the cells of a terminal that show them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from space.drawing.braille import BLANK, BRAILLE, DOTS_ACROSS, DOTS_DOWN, characters
from space.drawing.paints import RAMP_FROM, RAMP_STEPS, Paints, Tint
from space.drawing.sign_rows import SignRows

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from space.drawing.shapes import Places

UPPER_HALF, LOWER_HALF, FULL_BLOCK = 0x2580, 0x2584, 0x2588
FEW_DOTS, MANY_DOTS = 3, 6
"""Of a cell: from where one dot more or less is not seen, and from where it is nearly solid."""
_DOTS = np.array([bits.bit_count() for bits in range(256)], dtype=np.int8)
NEARER = 2.0**-9
"""Strokes are drawn this share of their depth nearer, so that edges stand out from faces."""
MOST_STEPS = 400_000
"""Dots of all strokes of one shape; with more, their dots are farther apart."""
DEPTH_LEVELS = 65_535
FLOORS = (Tint.FREE, Tint.MAYBE)
"""Behind a text these are readable."""
SMALL_FACES = (2, 5, 12)
"""Longest edges, in dots, up to which triangles are filled by dots."""


@dataclass(frozen=True, eq=False)
class CellPicture:
    """Characters and paints of all cells, each of shape (rows, columns)."""

    codes: NDArray[np.uint16]
    front: Paints
    back: Paints

    def changed(self, before: CellPicture) -> NDArray[np.bool_]:
        """Return which cells differ from another picture of the same shape."""
        differ: NDArray[np.bool_] = self.codes != before.codes
        differ |= self.front != before.front
        differ |= self.back != before.back
        return differ

    def steadied(self, before: CellPicture) -> CellPicture:
        """Return the picture with the earlier cells where hardly anything differs.

        The noise of a sensor moves values to the next step of the ramp, and dots at the edges of
        surfaces; neither must flicker. Cells with few dots are always exact.
        """
        near = _near(self.front, before.front) & _near(self.back, before.back)
        dots, dots_before = _DOTS[self.codes & 0xFF], _DOTS[before.codes & 0xFF]
        surface = np.minimum(dots, dots_before) >= FEW_DOTS
        braille = (self.codes > BRAILLE) & (before.codes > BRAILLE)
        alike = np.abs(dots - dots_before) <= 1
        same = self.codes == before.codes
        drift = _DOTS[(self.codes ^ before.codes) & 0xFF] <= 1
        solid = np.minimum(_solid(self.codes, dots), _solid(before.codes, dots_before)) >= MANY_DOTS
        kept = near & (same | (braille & surface & alike & drift) | solid)
        return CellPicture(
            np.where(kept, before.codes, self.codes),
            np.where(kept, before.front, self.front),
            np.where(kept, before.back, self.back),
        )


def _near(now: Paints, then: Paints) -> NDArray[np.bool_]:
    """Whether tints are the same, or next to each other on the ramp."""
    ramps = (now >= RAMP_FROM) & (now < RAMP_FROM + RAMP_STEPS)
    ramps &= (then >= RAMP_FROM) & (then < RAMP_FROM + RAMP_STEPS)
    near: NDArray[np.bool_] = np.abs(now.astype(np.int16) - then) <= np.where(ramps, 1, 0)
    return near


def _solid(codes: NDArray[np.uint16], dots: NDArray[np.int8]) -> NDArray[np.int8]:
    """How many dots are set, all of them in a block; none in a text."""
    block = (codes == UPPER_HALF) | (codes == LOWER_HALF) | (codes == FULL_BLOCK)
    return np.where(codes > BRAILLE, dots, np.where(block, 8, 0)).astype(np.int8)


class Raster:
    """A picture of dots; what is nearer covers what is farther away."""

    def __init__(self, columns: int, rows: int, signs_before: Mapping[str, int | None] | None = None) -> None:
        """Begin with nothing, in this many cells; `signs_before` is from the picture before."""
        self.columns, self.rows = columns, rows
        self.width, self.height = DOTS_ACROSS * columns, DOTS_DOWN * rows
        self._depth = np.full(self.width * self.height, np.inf, dtype=np.float32)
        self._paint = np.zeros(self.width * self.height, dtype=np.uint8)
        self.floor = np.zeros((2 * rows, columns), dtype=np.uint8)
        """The paints behind all dots, in halves of cells."""
        self.signs = SignRows(rows, signs_before or {})

    def dots(self, spots: Places, paint: int | Paints) -> None:
        """Set dots, given as (x, y, depth); those outside, and NaN, are ignored."""
        x, y, depth = spots[:, 0], spots[:, 1], spots[:, 2]
        inside = np.flatnonzero((x >= 0) & (x < self.width) & (y >= 0) & (y < self.height))
        if not inside.size:
            return
        depth = depth[inside]
        at = y[inside].astype(np.int32) * np.int32(self.width) + x[inside].astype(np.int32)
        several = isinstance(paint, np.ndarray)
        paints: Paints = paint[inside] if several else np.full(0, 0, dtype=np.uint8)  # type: ignore[index]
        visible = np.flatnonzero(depth <= self._depth[at])
        if not visible.size:
            return
        at, depth = at[visible], depth[visible]
        if several:
            # The nearest last: of several dots in one place, the last one stays.
            order = np.argsort(_levels(depth), kind="stable")[::-1]
            at, depth, paints = at[order], depth[order], paints[visible][order]
            self._depth[at], self._paint[at] = depth, paints
        else:
            np.minimum.at(self._depth, at, depth)
            self._paint[at] = paint

    def strokes(self, starts: Places, ends: Places, paint: int | Paints) -> None:
        """Draw straight lines between spots (x, y, depth); both ends must be numbers."""
        clear = np.isfinite(starts).all(axis=1) & np.isfinite(ends).all(axis=1)
        first, last = self._clipped(starts[clear], ends[clear])
        shown = first <= last
        starts, ends = starts[clear][shown], ends[clear][shown]
        first, last = first[shown], last[shown]
        if not len(starts):
            return
        way = ends - starts
        begin, end = starts + way * first[:, None], starts + way * last[:, None]
        steps = np.maximum(1, np.ceil(np.abs(end - begin)[:, :2].max(axis=1))).astype(np.int64)
        total = int(steps.sum()) + len(steps)
        if total > MOST_STEPS:
            steps = np.maximum(1, steps * MOST_STEPS // total)
        counts = steps + 1
        which = np.repeat(np.arange(len(counts)), counts)
        number = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)
        share = (number / steps[which]).astype(np.float32)[:, None]
        spots = begin[which] + (end - begin)[which] * share
        spots[:, 2] -= np.abs(spots[:, 2]) * NEARER + NEARER
        several = isinstance(paint, np.ndarray)
        self.dots(spots, paint[clear][shown][which] if several else paint)  # type: ignore[index]

    def _clipped(self, starts: Places, ends: Places) -> tuple[Places, Places]:
        """Which part of each line is inside, as shares of its length (Liang-Barsky)."""
        first = np.zeros(len(starts), dtype=np.float32)
        last = np.ones(len(starts), dtype=np.float32)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            for axis, most in ((0, self.width), (1, self.height)):
                begin = starts[:, axis]
                way = ends[:, axis] - begin
                one, other = -begin / way, (most - begin) / way
                outside = (way == 0) & ((begin < 0) | (begin > most))
                still = way == 0
                near = np.where(still, 0, np.minimum(one, other))
                far = np.where(still, np.where(outside, -1, 1), np.maximum(one, other))
                first, last = np.maximum(first, near), np.minimum(last, far)
        return first, last

    def faces(self, corners: Places, paint: int | Paints) -> None:
        """Fill triangles of spots (x, y, depth), of shape (n, 3, 3); those with NaN are ignored.

        Small ones are filled by dots, many at a time; there are hundreds in a robot.
        """
        clear = np.isfinite(corners).all(axis=(1, 2))
        edges = np.abs(corners - np.roll(corners, 1, axis=1))[..., :2].max(axis=(1, 2))
        paints = np.broadcast_to(np.asarray(paint, dtype=np.uint8), len(corners))
        least = 0.0
        for size in SMALL_FACES:
            chosen = np.flatnonzero(clear & (edges > least) & (edges <= size))
            if chosen.size:
                shares = _lattice(size)
                spots = np.einsum("sc,nca->nsa", shares, corners[chosen])
                self.dots(spots.reshape(-1, 3), np.repeat(paints[chosen], len(shares)))
            least = size
        for number in np.flatnonzero(clear & (edges > least)).tolist():
            self._large_face(corners[number], int(paints[number]))

    def _large_face(self, corners: Places, paint: int) -> None:
        least = np.clip(np.floor(corners.min(axis=0)[:2]), 0, (self.width, self.height))
        most = np.clip(np.ceil(corners.max(axis=0)[:2]), 0, (self.width, self.height))
        (x0, y0), (x1, y1) = least.astype(int), most.astype(int)
        a, b, c = corners.astype(np.float64)
        area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
        if x1 <= x0 or y1 <= y0 or not area:
            return
        x = np.arange(x0, x1) + 0.5
        y = (np.arange(y0, y1) + 0.5)[:, None]
        one = ((b[0] - x) * (c[1] - y) - (c[0] - x) * (b[1] - y)) / area
        two = ((c[0] - x) * (a[1] - y) - (a[0] - x) * (c[1] - y)) / area
        three = 1.0 - one - two
        depth = one * a[2] + two * b[2] + three * c[2]
        whole = self._depth.reshape(self.height, self.width)[y0:y1, x0:x1]
        set_here = (one >= 0) & (two >= 0) & (three >= 0) & (depth < whole)
        whole[set_here] = depth[set_here]
        self._paint.reshape(self.height, self.width)[y0:y1, x0:x1][set_here] = paint

    def sign(self, x: float, y: float, text: str, paint: int, name: str = "") -> None:
        """Write a text over the dots, its first character at a dot; parts outside are cut.

        Where another text is already, it goes into a row close by, or is left out. With a `name`,
        it does the same in the next picture, if it can.
        """
        if 0 <= x < self.width and 0 <= y < self.height and text:
            self.signs.write(int(y) // DOTS_DOWN, int(x) // DOTS_ACROSS, text, paint, name)

    def cells(self) -> CellPicture:
        """Return the cells; a cell whose dots are all set is drawn as two halves."""
        shape = (self.rows, DOTS_DOWN, self.columns, DOTS_ACROSS)
        depth = self._depth.reshape(shape).transpose(0, 2, 1, 3).reshape(self.rows, self.columns, 8)
        paint = self._paint.reshape(shape).transpose(0, 2, 1, 3).reshape(self.rows, self.columns, 8)
        codes = characters(self._paint.reshape(self.height, self.width) > 0)
        upper, lower = (_nearest(depth[..., :4], paint[..., :4]), _nearest(depth[..., 4:], paint[..., 4:]))
        front = _nearest(depth, paint)
        above, below = self.floor[0::2], self.floor[1::2]
        full = (paint > 0).all(axis=2)
        empty = codes == BLANK
        split = (full & ~_near(upper, lower)) | (empty & (above != below))
        codes = np.where(full, np.uint16(FULL_BLOCK), codes)
        codes = np.where(split, np.uint16(UPPER_HALF), codes)
        front = np.where(full & split, upper, np.where(empty & split, above, front))
        back = np.where(below > 0, below, above)
        back = np.where(full & split, lower, np.where(full, 0, np.where(empty, below, back)))
        front = np.where(empty & ~split, 0, front)
        # The background of the screen has no paint to be the front of a half.
        swap = (codes == UPPER_HALF) & (front == 0)
        codes = np.where(swap, np.uint16(LOWER_HALF), codes)
        front, back = np.where(swap, back, front), np.where(swap, 0, back)
        picture = CellPicture(codes, front.astype(np.uint8), back.astype(np.uint8))
        self._write_signs(picture)
        return picture

    def _write_signs(self, picture: CellPicture) -> None:
        for row, column, text, paint in self.signs.written:
            shown = text[: self.columns - column]
            for place, char in enumerate(shown, column):
                picture.codes[row, place] = ord(char)
                picture.front[row, place] = paint
                if picture.back[row, place] not in FLOORS:
                    picture.back[row, place] = Tint.NOTHING


@lru_cache(maxsize=len(SMALL_FACES))
def _lattice(size: int) -> NDArray[np.float32]:
    """Shares of the three corners, of shape (m, 3), for dots all over a triangle of this size."""
    steps = size + 1
    rows = [(one, two, steps - one - two) for one in range(steps + 1) for two in range(steps + 1 - one)]
    return np.array(rows, dtype=np.float32) / np.float32(steps)


def _nearest(depth: NDArray[np.float32], paint: Paints) -> Paints:
    """The paint of the nearest dot along the last axis; 0 if there is none."""
    at = depth.argmin(axis=2)
    return np.take_along_axis(paint, at[..., None], axis=2)[..., 0]


def _levels(depth: NDArray[np.float32]) -> NDArray[np.uint16]:
    """Depths as small whole numbers, which numpy sorts in a fraction of the time."""
    least, most = float(depth.min()), float(depth.max())
    if not most > least:
        return np.zeros(len(depth), dtype=np.uint16)
    return ((depth - least) * (DEPTH_LEVELS / (most - least))).astype(np.uint16)

"""Drawables in one fixed frame, by the transforms that are known."""

from __future__ import annotations

import math
from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

from space.buffer import NoTransformError
from space.drawing.shapes import Speckles, moved
from space.drawing.thinning import FEW, thinned
from space.reading.fields import FARTHEST_FRAME_M, Drawable
from text.sentences import reason_of, say

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from space.buffer import TransformBuffer
    from space.drawing.camera import SpaceCamera
    from space.drawing.shapes import Shape
    from space.transform import Transform

ROOTS = ("map", "odom", "base_link")
"""Frames of REP-105: the tree that has the first of them is the robot's."""
SMALLEST_CUBE_M = 0.004


def robot_root(buffer: TransformBuffer, others: Iterable[str] = ()) -> str:
    """Return the root of the robot's tree; without frames, the first of `others`, or nothing."""
    known = buffer.frames
    for name in ROOTS:
        if name in known:
            return buffer.way_up(name)[-1]
    roots = Counter(buffer.way_up(frame)[-1] for frame in sorted(known))
    if roots:
        return roots.most_common(1)[0][0]
    return next(iter(others), "")


def cube_of(camera: SpaceCamera) -> float:
    """Return the size to which clouds are thinned: about a dot, in steps of two."""
    return max(SMALLEST_CUBE_M, 2.0 ** math.floor(math.log2(1.0 / camera.dots_per_m)))


class Located(NamedTuple):
    """A drawable, and where it is in the fixed frame."""

    drawable: Drawable
    at: Transform

    def looks_like(self, other: Located, metres: float) -> bool:
        """Return whether it is the same drawable in the same place."""
        return self.drawable is other.drawable and self.at.is_near(other.at, metres)


class Placer:
    """Turns drawables into shapes of the fixed frame, and remembers thinned clouds."""

    def __init__(self, mounts: Mapping[str, tuple[str, Transform]] | None = None) -> None:
        """`mounts` says where frames are that nobody publishes: frame to (parent, place)."""
        self._mounts = dict(mounts or {})
        self._marks: dict[str, Drawable] = {}
        """What stands for each frame itself."""
        self._thinned: dict[int, tuple[Speckles, float, Speckles]] = {}

    def root(self, buffer: TransformBuffer, others: Iterable[str]) -> str:
        """Return the root of the robot's tree; without frames, of that of the first of `others`."""
        return robot_root(buffer, (self._mounts[one][0] if one in self._mounts else one for one in others))

    def where(self, buffer: TransformBuffer, fixed: str, frame: str, stamp_s: float | None = None) -> Transform:
        """Return where a frame is, at that time if it is known.

        Raises NoTransformError, also for one that is farther away than the Earth is wide.
        """
        at = self._where(buffer, fixed, frame, stamp_s)
        if max(map(abs, at.translation)) > FARTHEST_FRAME_M:
            km = f"{FARTHEST_FRAME_M / 1000:g}"
            raise NoTransformError(
                say("{frame} is farther than {km} km from {fixed}", frame=frame, km=km, fixed=fixed)
            )
        return at

    def _where(self, buffer: TransformBuffer, fixed: str, frame: str, stamp_s: float | None) -> Transform:
        if frame in self._mounts and frame not in buffer.frames:
            parent, place = self._mounts[frame]
            return self._where(buffer, fixed, parent, stamp_s) @ place
        if stamp_s is not None:
            try:
                return buffer.find(fixed, frame, stamp_s)
            except NoTransformError:
                # Transforms come a little later than what was measured, or its clock differs.
                pass
        return buffer.find(fixed, frame)

    def find(self, buffer: TransformBuffer, fixed: str, drawables: Iterable[Drawable]) -> tuple[list[Located], str]:
        """Return where each drawable is, and why others are not found; empty if all are."""
        found: list[Located] = []
        why = ""
        for one in drawables:
            if not one.shapes:
                continue
            try:
                found.append(Located(one, self.where(buffer, fixed, one.frame, one.stamp_s)))
            except NoTransformError as error:
                why = why or say("not joined to {fixed}: {reason}", fixed=fixed, reason=reason_of(error))
        return found, why

    def frames(self, buffer: TransformBuffer, fixed: str) -> tuple[list[Located], list[str]]:
        """Return where all frames are, parents first, and those not joined to the fixed one."""
        found: list[Located] = []
        apart: list[str] = []
        for frame in sorted(buffer.frames, key=lambda one: (len(buffer.way_up(one)), one)):
            mark = self._marks.setdefault(frame, Drawable(frame, ()))
            try:
                found.append(Located(mark, self.where(buffer, fixed, frame)))
            except NoTransformError:
                apart.append(frame)
        return found, sorted(apart)

    def place(self, found: Iterable[Located], cube_m: float) -> list[Shape]:
        """Return the shapes of drawables in the fixed frame."""
        return [moved(self._thin(shape, cube_m), one.at) for one in found for shape in one.drawable.shapes]

    def _thin(self, shape: Shape, cube_m: float) -> Shape:
        if not isinstance(shape, Speckles) or len(shape.places) <= FEW:
            return shape
        known = self._thinned.get(id(shape))
        if known is not None and known[0] is shape and known[1] == cube_m:
            return known[2]
        if len(self._thinned) > 16:
            self._thinned.clear()
        fewer = thinned(shape, cube_m)
        self._thinned[id(shape)] = shape, cube_m, fewer
        return fewer

"""Drawables in one fixed frame, by the transforms that are known."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from space.buffer import NoTransformError
from space.drawing.shapes import Sign, axes, moved
from space.reading.fields import FARTHEST_FRAME_M
from text.plain import plain
from text.sentences import reason_of, say

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from space.buffer import TransformBuffer
    from space.drawing.shapes import Shape
    from space.reading.fields import Drawable
    from space.transform import Transform

ROOTS = ("map", "odom", "base_link")
"""Frames of REP-105: the tree that has the first of them is the robot's."""


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


class Placer:
    """Turns drawables into shapes of the fixed frame."""

    def __init__(self, mounts: Mapping[str, tuple[str, Transform]] | None = None) -> None:
        """`mounts` says where frames are that nobody publishes: frame to (parent, place)."""
        self._mounts = dict(mounts or {})

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
                return buffer.find(fixed, frame)
        return buffer.find(fixed, frame)

    def place(self, buffer: TransformBuffer, fixed: str, drawables: Iterable[Drawable]) -> tuple[list[Shape], str]:
        """Return shapes in the fixed frame, and why others are not found; empty if all are."""
        found: list[Shape] = []
        why = ""
        for one in drawables:
            if not one.shapes:
                continue
            try:
                at = self.where(buffer, fixed, one.frame, one.stamp_s)
                found += [moved(shape, at) for shape in one.shapes]
            except NoTransformError as error:
                why = why or say("not joined to {fixed}: {reason}", fixed=fixed, reason=reason_of(error))
        return found, why

    def frames(self, buffer: TransformBuffer, fixed: str) -> tuple[dict[str, Transform], list[str]]:
        """Return where all frames are, parents first, and those not joined to the fixed one."""
        found: dict[str, Transform] = {}
        apart: list[str] = []
        for frame in sorted(buffer.frames, key=lambda one: (len(buffer.way_up(one)), one)):
            try:
                found[frame] = self.where(buffer, fixed, frame)
            except NoTransformError:  # noqa: PERF203
                apart.append(frame)
        return found, sorted(apart)


AXIS_M, LEAST_AXIS_DOTS, MOST_AXIS_DOTS = 0.15, 5.0, 30.0
LONGEST_NAME = 40
TOGETHER_DOTS = 4.0
"""Frames that come as close in the picture share a line for their names."""
NAMED_TOGETHER = 2
"""In a line; of more frames it has the first one, and how many others there are."""


def frame_shapes(frames: Mapping[str, Transform], dots_per_m: float, first: Sequence[str] = ()) -> list[Shape]:
    """Return what is drawn of frames; the names of `first` come first, then in the order given.

    Axes are 0.15 m long, but never too small or too large to be seen.
    """
    size = min(max(AXIS_M * dots_per_m, LEAST_AXIS_DOTS), MOST_AXIS_DOTS)
    shapes: list[Shape] = [axis for at in frames.values() for axis in axes(at, size / dots_per_m)]
    lines: dict[tuple[int, int], list[str]] = {}
    for frame in dict.fromkeys((*(one for one in first if one in frames), *frames)):
        x, y, _z = frames[frame].translation
        square = round(x * dots_per_m / TOGETHER_DOTS), round(y * dots_per_m / TOGETHER_DOTS)
        lines.setdefault(square, []).append(frame)
    for line in lines.values():
        names = [plain(frame, LONGEST_NAME) for frame in line]
        text = ", ".join(names) if len(names) <= NAMED_TOGETHER else f"{names[0]} +{len(names) - 1}"
        shapes.append(Sign(frames[line[0]].translation, text))
    return shapes

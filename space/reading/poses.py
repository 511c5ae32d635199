"""Where something is or is to go: PoseStamped, Path, Odometry with what it has driven."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from space.drawing.paints import Tint
from space.drawing.shapes import Strokes, arrow, dart, places, polyline
from space.reading.fields import Drawable, NotDrawnError, field, frame, listed, pose, stamp_s, vector
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Mapping

    from space.drawing.shapes import Shape
    from space.transform import Vector

ARROW_M, DART_M = 0.4, 0.36
LEAST_M = 0.02
"""Shorter ways are not added to a trail."""
TORN_M = 1.0
"""A longer way was not driven: the odometry was reset, or nobody was looking."""
MOST_PLACES = 4000


def read_goal(tree: Mapping[str, Any]) -> Drawable:
    """Return an arrow, or nothing: a goal without a frame says that there is none. Raises NotDrawnError."""
    if not str(field(tree, "header.frame_id")):
        return Drawable("", (), None, say("there is no goal now"))
    return Drawable(frame(tree), (arrow(pose(tree, "pose"), ARROW_M, Tint.GOOD),), stamp_s(tree))


def read_path(tree: Mapping[str, Any]) -> Drawable:
    """Return the line of a path. Raises NotDrawnError.

    Its poses are taken to be in the frame of the path, as planners publish them.
    """
    frame_id = frame(tree)
    others = 0
    found: list[Vector] = []
    for number, one in enumerate(listed(tree, "poses")):
        own = str(field(one, "header.frame_id")).lstrip("/")
        if own not in {"", frame_id}:
            others += 1
            continue
        try:
            found.append(vector(one, "pose.position"))
        except NotDrawnError as error:
            raise NotDrawnError(
                say("pose {number} of the path: {reason}", number=number, reason=error.args[0])
            ) from None
    remark = None
    if others:
        remark = say("poses in other frames are not drawn: {count}", count=others)
    shapes = (polyline(places(*found), Tint.GOOD),) if len(found) > 1 else ()
    return Drawable(frame_id, shapes, stamp_s(tree), remark)


class DrivenTrail:
    """An odometry's pose, and where it has been while somebody looked."""

    def __init__(self) -> None:
        """Begin with no trail."""
        self._frame = ""
        self._places: list[Vector] = []
        self._least_m = LEAST_M

    def read(self, tree: Mapping[str, Any]) -> Drawable:
        """Return an arrow, and the trail up to it. Raises NotDrawnError."""
        frame_id, at = frame(tree), pose(tree, "pose.pose")
        self.add(frame_id, at.translation)
        shapes: list[Shape] = [dart(at, DART_M, Tint.SECOND)]
        if len(self._places) > 1:
            shapes.append(self.line())
        return Drawable(frame_id, tuple(shapes), stamp_s(tree))

    def clear(self) -> None:
        self._places, self._least_m = [], LEAST_M

    def add(self, frame_id: str, place: Vector) -> bool:
        """Go on to a place, in another frame anew; return whether the trail has grown."""
        if frame_id != self._frame:
            self._frame, self._places = frame_id, []
        if self._places and math.dist(self._places[-1], place) < self._least_m:
            return False
        self._places.append(place)
        if len(self._places) > MOST_PLACES:
            self._places = self._places[::2]
            self._least_m *= 2
        return True

    def line(self) -> Strokes:
        points = places(*self._places)
        ways = points[1:] - points[:-1]
        torn = max(TORN_M, 2 * self._least_m)
        whole = np.hypot(np.hypot(ways[:, 0], ways[:, 1]), ways[:, 2]) <= torn
        return Strokes(points[:-1][whole], points[1:][whole], Tint.ACCENT)

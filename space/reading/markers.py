"""visualization_msgs/Marker and MarkerArray: shapes that stay until they are deleted or expire.

Numbers and meanings: visualization_msgs/msg/Marker.msg.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from space.drawing.paints import Tint, cube, nearest
from space.drawing.shapes import (
    Shape,
    Sign,
    Speckles,
    Strokes,
    arrow,
    box,
    cylinder,
    ellipsoid,
    moved,
    polyline,
)
from space.reading.fields import (
    Drawable,
    NotDrawnError,
    field,
    frame,
    is_near,
    listed,
    number,
    points,
    pose,
    vector,
    whole,
)
from space.transform import Transform
from text.plain import plain
from text.sentences import reason_of, say

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from space.drawing.paints import Paints
    from space.drawing.shapes import Places
    from text.sentences import Words

ADD, DELETE, DELETE_ALL = 0, 2, 3
NAMES = (
    "ARROW",
    "CUBE",
    "SPHERE",
    "CYLINDER",
    "LINE_STRIP",
    "LINE_LIST",
    "CUBE_LIST",
    "SPHERE_LIST",
    "POINTS",
    "TEXT_VIEW_FACING",
    "MESH_RESOURCE",
    "TRIANGLE_LIST",
    "ARROW_STRIP",
)
MOST_MARKERS = 5_000
MOST_SOLIDS = 500
"""Of the cubes or spheres of one list that are drawn as such; more are drawn as points."""
LONGEST_TEXT = 60


@dataclass(frozen=True, eq=False)
class _KeptMarker:
    drawable: Drawable
    ends_s: float
    """When it expires; infinity for never."""


class MarkerBook:
    """All markers of one topic; one of the same namespace and id replaces the one before."""

    def __init__(self) -> None:
        """Begin with no markers."""
        self._kept: dict[tuple[str, int], _KeptMarker] = {}
        self._refused: dict[tuple[str, int], str] = {}
        """What kind the markers are that are not drawn."""

    def clear(self) -> None:
        """Forget all markers."""
        self._kept.clear()
        self._refused.clear()

    def read(self, tree: Mapping[str, Any], now_s: float) -> None:
        """Take in a Marker or a MarkerArray that has come at this time.

        Raises NotDrawnError; the markers before the one that cannot be read are kept.
        """
        for one in listed(tree, "markers") if "markers" in tree else (tree,):
            self._take(one, now_s)

    def shown(self, now_s: float) -> list[Drawable]:
        """Return what is to be seen now."""
        for key in [key for key, one in self._kept.items() if one.ends_s <= now_s]:
            del self._kept[key]
        return [one.drawable for one in self._kept.values()]

    @property
    def remark(self) -> Words | None:
        """What is not drawn, and why; None if everything is."""
        if not self._refused:
            return None
        counted = sorted(Counter(self._refused.values()).items())
        kinds = ", ".join(f"{name} ({count})" for name, count in counted)
        return say("not drawn: {kinds}", kinds=kinds)

    def _take(self, tree: Mapping[str, Any], now_s: float) -> None:
        key = (str(field(tree, "ns")), whole(tree, "id"))
        action = whole(tree, "action")
        if action == DELETE_ALL:
            self.clear()
        elif action == DELETE:
            self._kept.pop(key, None)
            self._refused.pop(key, None)
        elif action == ADD:
            self._add(key, tree, now_s)
        else:
            raise NotDrawnError(say("a marker has the unknown action {action}", action=action))

    def _add(self, key: tuple[str, int], tree: Mapping[str, Any], now_s: float) -> None:
        kind = whole(tree, "type")
        make = _MAKERS.get(kind)
        self._refused.pop(key, None)
        if make is None:
            self._kept.pop(key, None)
            if len(self._refused) < MOST_MARKERS:
                self._refused[key] = NAMES[kind] if 0 <= kind < len(NAMES) else str(kind)
            return
        if key not in self._kept and len(self._kept) >= MOST_MARKERS:
            raise NotDrawnError(say("more than {count} markers are not kept", count=MOST_MARKERS))
        try:
            at, size = pose(tree, "pose"), vector(tree, "scale")
            shapes = make(tree, Transform(), size)
            drawable = Drawable(frame(tree), tuple(moved(shape, at) for shape in shapes))
        except NotDrawnError as error:
            name = plain(f"{key[0]}/{key[1]}" if key[0] else str(key[1]), LONGEST_TEXT)
            raise NotDrawnError(
                say("marker {name}: {reason}", name=name, reason=reason_of(error))
            ) from None
        lifetime_s = number(tree, "lifetime.sec") + 1e-9 * number(tree, "lifetime.nanosec")
        ends_s = now_s + lifetime_s if lifetime_s > 0 else math.inf
        self._kept[key] = _KeptMarker(drawable, ends_s)


def _colour(tree: Mapping[str, Any]) -> int:
    return nearest(*(number(tree, f"color.{channel}") for channel in "rgb"))


def _colours(tree: Mapping[str, Any], count: int) -> int | Paints:
    """The paints of the points, if there is one for each, otherwise that of the marker."""
    found = listed(tree, "colors")
    if len(found) != count or not count:
        return _colour(tree)
    rgb = np.array([[number(one, channel) for channel in "rgb"] for one in found])
    return cube((np.clip(rgb, 0, 1) * 255).astype(np.uint8))


def _make_arrow(tree: Mapping[str, Any], at: Transform, size: Sequence[float]) -> list[Shape]:
    ends = points(tree, "points")
    if len(ends) < 2:
        return [arrow(at, size[0], _colour(tree))]
    start, end = ends[0], ends[1]
    way = end - start
    length = float(np.linalg.norm(way))
    flat = float(np.hypot(way[0], way[1]))
    turn = (0.0, -math.atan2(float(way[2]), flat), math.atan2(float(way[1]), float(way[0])))
    begin = (float(start[0]), float(start[1]), float(start[2]))
    return [arrow(Transform.from_rpy(begin, turn), length, _colour(tree))]


def _make_box(tree: Mapping[str, Any], at: Transform, size: Sequence[float]) -> list[Shape]:
    return list(box(at, (size[0], size[1], size[2]), _colour(tree)))


def _make_ball(tree: Mapping[str, Any], at: Transform, size: Sequence[float]) -> list[Shape]:
    return list(ellipsoid(at, (size[0], size[1], size[2]), _colour(tree)))


def _make_cylinder(tree: Mapping[str, Any], at: Transform, size: Sequence[float]) -> list[Shape]:
    return list(cylinder(at, (size[0], size[1], size[2]), _colour(tree)))


def _clear_points(tree: Mapping[str, Any]) -> tuple[Places, int | Paints]:
    found = points(tree, "points")
    paint = _colours(tree, len(found))
    near = is_near(found) if len(found) else np.zeros(0, dtype=np.bool_)
    return found[near], paint[near] if isinstance(paint, np.ndarray) else paint


def _make_strip(tree: Mapping[str, Any], at: Transform, size: Sequence[float]) -> list[Shape]:
    del at, size
    found, paint = _clear_points(tree)
    line = paint[1:] if isinstance(paint, np.ndarray) else paint
    return [polyline(found, line)] if len(found) > 1 else []


def _make_lines(tree: Mapping[str, Any], at: Transform, size: Sequence[float]) -> list[Shape]:
    del at, size
    found = points(tree, "points")
    if len(found) % 2:
        raise NotDrawnError(say("a LINE_LIST has an odd number of points"))
    paint = _colours(tree, len(found))
    both = is_near(found) if len(found) else np.zeros(0, dtype=np.bool_)
    both = both[0::2] & both[1::2]
    line = paint[0::2][both] if isinstance(paint, np.ndarray) else paint
    return [Strokes(found[0::2][both], found[1::2][both], line)]


def _make_points(tree: Mapping[str, Any], at: Transform, size: Sequence[float]) -> list[Shape]:
    del at
    return [Speckles(*_clear_points(tree), solid_m=min(abs(size[0]), 0.2))]


def _make_solids(
    one: Callable[[Transform, tuple[float, float, float], int], Sequence[Shape]],
) -> Callable[[Mapping[str, Any], Transform, Sequence[float]], list[Shape]]:
    def make(tree: Mapping[str, Any], at: Transform, size: Sequence[float]) -> list[Shape]:
        del at
        found, paint = _clear_points(tree)
        if len(found) > MOST_SOLIDS:
            return [Speckles(found, paint, solid_m=min(abs(size[0]), 0.2))]
        shapes: list[Shape] = []
        for place, (x, y, z) in enumerate(found.tolist()):
            own = int(paint[place]) if isinstance(paint, np.ndarray) else paint
            shapes += one(Transform((x, y, z)), (size[0], size[1], size[2]), own)
        return shapes

    return make


def _make_text(tree: Mapping[str, Any], at: Transform, size: Sequence[float]) -> list[Shape]:
    del size
    text = plain(str(field(tree, "text")), LONGEST_TEXT)
    return [Sign(at.translation, text, _colour(tree) if text else Tint.TEXT)]


_MAKERS: dict[int, Callable[[Mapping[str, Any], Transform, Sequence[float]], list[Shape]]] = {
    0: _make_arrow,
    1: _make_box,
    2: _make_ball,
    3: _make_cylinder,
    4: _make_strip,
    5: _make_lines,
    6: _make_solids(box),
    7: _make_solids(ellipsoid),
    8: _make_points,
    9: _make_text,
}

"""visualization_msgs/Marker and MarkerArray: shapes that stay until they are deleted or expire.

Numbers and meanings: visualization_msgs/msg/Marker.msg.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Any

import numpy as np

from space.drawing.paints import cube, nearest
from space.drawing.shapes import Shape, Sign, Speckles, Strokes, arrow, box, cylinder, ellipsoid, moved, polyline
from space.reading.fields import (
    Drawable,
    NotDrawnError,
    field,
    finite,
    frame,
    is_near,
    listed,
    number,
    pose,
    table,
    vector,
    whole,
)
from space.transform import IDENTITY, Transform
from text.plain import plain
from text.sentences import reason_of, say

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from space.drawing.paints import Paints
    from space.drawing.shapes import Places
    from space.transform import Vector
    from text.sentences import Words

    _Maker = Callable[["MarkerFigure"], Sequence[Shape]]
    _Solid = Callable[[Transform, Vector, int], Sequence[Shape]]

MOST_MARKERS = 5_000
MOST_SOLIDS = 500
"""Of the cubes or spheres of one list that are drawn as such; more are drawn as points."""
LONGEST_TEXT = 60


LONGEST_NAME = 60


class MarkerAction(IntEnum):
    """What a marker is for."""

    ADD = 0
    DELETE = 2
    DELETE_ALL = 3


class MarkerKind(IntEnum):
    """What a marker shows."""

    ARROW = 0
    CUBE = 1
    SPHERE = 2
    CYLINDER = 3
    LINE_STRIP = 4
    LINE_LIST = 5
    CUBE_LIST = 6
    SPHERE_LIST = 7
    POINTS = 8
    TEXT_VIEW_FACING = 9
    MESH_RESOURCE = 10
    TRIANGLE_LIST = 11
    ARROW_STRIP = 12


MANY = frozenset(
    {
        MarkerKind.LINE_STRIP,
        MarkerKind.LINE_LIST,
        MarkerKind.CUBE_LIST,
        MarkerKind.SPHERE_LIST,
        MarkerKind.POINTS,
        MarkerKind.TRIANGLE_LIST,
    }
)
"""The kinds whose points have colours of their own."""
TOGETHER = {MarkerKind.LINE_LIST: 2, MarkerKind.TRIANGLE_LIST: 3}
"""How many points of a list make one thing."""


@dataclass(frozen=True, eq=False)
class MarkerFigure:
    """A marker that is to be drawn."""

    kind: MarkerKind
    frame: str
    at: Transform
    size: Vector
    points: Places
    """Those that are places, in the frame of `at`."""
    rgba: NDArray[np.float64]
    """From 0 to 1: a row for each point, or one for all."""
    text: str
    lifetime_s: float
    """0 for ever."""

    @property
    def way(self) -> Places:
        """Both ends of an arrow."""
        if len(self.points) > 1:
            return self.points[:2]
        return np.array([(0.0, 0.0, 0.0), (self.size[0], 0.0, 0.0)], dtype=np.float32)


def marker_key(tree: Mapping[str, Any]) -> tuple[str, int]:
    """Return the namespace and the number, which name a marker. Raises NotDrawnError."""
    return str(field(tree, "ns")), whole(tree, "id")


def marker_action(tree: Mapping[str, Any]) -> MarkerAction:
    """Return what a marker is for. Raises NotDrawnError."""
    action = whole(tree, "action")
    try:
        return MarkerAction(action)
    except ValueError:
        raise NotDrawnError(say("a marker has the unknown action {action}", action=action)) from None


def kind_name(kind: int) -> str:
    """Return what a kind is called, the number of one that does not exist."""
    return MarkerKind(kind).name if kind in MarkerKind.__members__.values() else str(kind)


def read_figure(tree: Mapping[str, Any]) -> MarkerFigure:
    """Return a marker of a kind that exists. Raises NotDrawnError, with the marker's name."""
    try:
        return _figure(tree)
    except NotDrawnError as error:
        space, name = marker_key(tree)
        called = plain(f"{space}/{name}" if space else str(name), LONGEST_NAME)
        raise NotDrawnError(say("marker {name}: {reason}", name=called, reason=reason_of(error))) from None


def _figure(tree: Mapping[str, Any]) -> MarkerFigure:
    kind, size = MarkerKind(whole(tree, "type")), vector(tree, "scale")
    if min(size) < 0:
        raise NotDrawnError(say("its scale has to be positive numbers: {size}", size=size))
    found = table(tree, "points", "xyz")
    together = TOGETHER.get(kind, 1)
    if len(found) % together:
        raise NotDrawnError(
            say(
                "a {kind} needs a multiple of {several} points, and has {count}",
                kind=kind.name,
                several=together,
                count=len(found),
            )
        )
    near = is_near(found).reshape(-1, together).all(axis=1).repeat(together)
    return MarkerFigure(
        kind,
        frame(tree),
        pose(tree, "pose"),
        size,
        found[near],
        _rgba(tree, near if kind in MANY else near[:0]),
        str(field(tree, "text")),
        number(tree, "lifetime.sec") + 1e-9 * number(tree, "lifetime.nanosec"),
    )


def _rgba(tree: Mapping[str, Any], near: NDArray[np.bool_]) -> NDArray[np.float64]:
    """The colours of the points, if there is one for each, otherwise that of the marker."""
    if len(near) and len(listed(tree, "colors")) == len(near):
        found = np.nan_to_num(table(tree, "colors", "rgba")[near].astype(np.float64))
    else:
        found = np.array([finite(tree, "color", "rgba")])
    return found.clip(0.0, 1.0)


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
        self._kept.clear()
        self._refused.clear()

    def read(self, tree: Mapping[str, Any], now_s: float) -> None:
        """Take in a Marker or a MarkerArray that has come at this time.

        Raises NotDrawnError; the markers before the one that cannot be read are kept.
        """
        for one in listed(tree, "markers") if "markers" in tree else (tree,):
            self._take(one, now_s)

    def shown(self, now_s: float) -> list[Drawable]:
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
        key = marker_key(tree)
        action = marker_action(tree)
        if action == MarkerAction.DELETE_ALL:
            self.clear()
        elif action == MarkerAction.DELETE:
            self._kept.pop(key, None)
            self._refused.pop(key, None)
        else:
            self._add(key, tree, now_s)

    def _add(self, key: tuple[str, int], tree: Mapping[str, Any], now_s: float) -> None:
        kind = whole(tree, "type")
        make = _MAKERS.get(kind)
        self._refused.pop(key, None)
        if make is None:
            self._kept.pop(key, None)
            if len(self._refused) < MOST_MARKERS:
                self._refused[key] = kind_name(kind)
            return
        if key not in self._kept and len(self._kept) >= MOST_MARKERS:
            raise NotDrawnError(say("more than {count} markers are not kept", count=MOST_MARKERS))
        figure = read_figure(tree)
        shapes = tuple(moved(shape, figure.at) for shape in make(figure))
        ends_s = now_s + figure.lifetime_s if figure.lifetime_s > 0 else math.inf
        self._kept[key] = _KeptMarker(Drawable(figure.frame, shapes), ends_s)


def _paint(figure: MarkerFigure) -> int | Paints:
    """Return the paint of all, or that of each point."""
    paints = cube((figure.rgba[:, :3] * 255).astype(np.uint8))
    return int(paints[0]) if len(paints) == 1 else paints


def _make_arrow(figure: MarkerFigure) -> Sequence[Shape]:
    (x, y, z), end = figure.way.tolist()
    ahead, left, up = end[0] - x, end[1] - y, end[2] - z
    turn = (0.0, -math.atan2(up, math.hypot(ahead, left)), math.atan2(left, ahead))
    at = Transform.from_rpy((x, y, z), turn)
    return [arrow(at, math.hypot(ahead, left, up), _colour(figure))]


def _colour(figure: MarkerFigure) -> int:
    return nearest(*figure.rgba[0, :3].tolist())


def _make_solid(solid: _Solid) -> _Maker:
    return lambda figure: solid(IDENTITY, figure.size, _colour(figure))


def _make_strip(figure: MarkerFigure) -> Sequence[Shape]:
    paint = _paint(figure)
    line = paint[1:] if isinstance(paint, np.ndarray) else paint
    return [polyline(figure.points, line)] if len(figure.points) > 1 else []


def _make_lines(figure: MarkerFigure) -> Sequence[Shape]:
    paint = _paint(figure)
    line = paint[::2] if isinstance(paint, np.ndarray) else paint
    return [Strokes(figure.points[::2], figure.points[1::2], line)]


def _make_points(figure: MarkerFigure) -> Sequence[Shape]:
    return [Speckles(figure.points, _paint(figure), solid_m=min(figure.size[0], 0.2))]


def _make_solids(solid: _Solid) -> _Maker:
    def make(figure: MarkerFigure) -> Sequence[Shape]:
        if len(figure.points) > MOST_SOLIDS:
            return _make_points(figure)
        paint = _paint(figure)
        shapes: list[Shape] = []
        for place, (x, y, z) in enumerate(figure.points.tolist()):
            own = int(paint[place]) if isinstance(paint, np.ndarray) else paint
            shapes += solid(Transform((x, y, z)), figure.size, own)
        return shapes

    return make


def _make_text(figure: MarkerFigure) -> Sequence[Shape]:
    return [Sign((0.0, 0.0, 0.0), plain(figure.text, LONGEST_TEXT), _colour(figure))]


_MAKERS: dict[int, _Maker] = {
    MarkerKind.ARROW: _make_arrow,
    MarkerKind.CUBE: _make_solid(box),
    MarkerKind.SPHERE: _make_solid(ellipsoid),
    MarkerKind.CYLINDER: _make_solid(cylinder),
    MarkerKind.LINE_STRIP: _make_strip,
    MarkerKind.LINE_LIST: _make_lines,
    MarkerKind.CUBE_LIST: _make_solids(box),
    MarkerKind.SPHERE_LIST: _make_solids(ellipsoid),
    MarkerKind.POINTS: _make_points,
    MarkerKind.TEXT_VIEW_FACING: _make_text,
}

"""visualization_msgs/Marker: what one asks for, checked.

Numbers and meanings: visualization_msgs/msg/Marker.msg.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Any

import numpy as np

from space.reading.fields import (
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
from text.plain import plain
from text.sentences import reason_of, say

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from space.drawing.shapes import Places
    from space.transform import Transform, Vector

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

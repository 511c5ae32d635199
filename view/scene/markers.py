"""Shapes that nodes draw by themselves: `visualization_msgs/Marker`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from text.plain import plain
from text.sentences import reason_of, say
from view.scene.drawn import Drawn, UnusableMessageError, topic_path
from view.scene.geometry import colour, frame_of, pose, vector

if TYPE_CHECKING:
    from collections.abc import Callable

    from space.transform import Transform, Vector
    from view.scene.drawn import Message

MARKERS = "markers"
"""The root of all markers in the tree of entities."""
DELETE, DELETE_ALL = 2, 3
MESH = 10
LONGEST = 200


def marker(topic: str, message: Message) -> list[Drawn]:
    """Return what a marker draws, or that it is removed. Raises UnusableMessageError."""
    if message["action"] == DELETE_ALL:
        return [Drawn(topic_path(MARKERS, topic), (), recursive=True)]
    name = (plain(str(message["ns"]), LONGEST) or "_", str(message["id"]))
    path = topic_path(MARKERS, topic, *name)
    if message["action"] == DELETE:
        return [Drawn(path, (), recursive=True)]
    kind = int(message["type"])
    if kind not in _SHAPES:
        raise UnusableMessageError(_unknown(kind))
    shape = _SHAPES[kind](message, pose(message["pose"]))
    return [Drawn(path, (shape,), frame=frame_of(message))]


def several(topic: str, message: Message) -> list[Drawn]:
    """Return what a `MarkerArray` draws. Raises UnusableMessageError."""
    drawn: list[Drawn] = []
    fault = ""
    for one in message["markers"]:
        try:
            drawn += marker(topic, one)
        except UnusableMessageError as error:  # noqa: PERF203
            fault = reason_of(error)
    if fault:
        raise UnusableMessageError(fault, drawn)
    return drawn


def _unknown(kind: int) -> str:
    if kind == MESH:
        return say("a marker of type MESH_RESOURCE needs a file, and is not drawn")
    return say("there is no marker of type {number}", number=kind)


def _points(message: Message, at: Transform) -> list[Vector]:
    """Return the points in the marker's frame, without those that are none."""
    points = [vector(point) for point in message["points"]]
    return [at.point(point) for point in points if all(map(math.isfinite, point))]


def _size(message: Message) -> Vector:
    size = vector(message["scale"])
    if not all(math.isfinite(one) and one >= 0 for one in size):
        raise UnusableMessageError(say("its scale has to be positive numbers: {size}", size=size))
    return size


def _arrow(message: Message, at: Transform) -> Any:  # noqa: ANN401
    import rerun

    size, ends = _size(message), _points(message, at)
    if len(ends) == 2:
        begin, end, radius = ends[0], ends[1], size[0] / 2
    else:
        begin, end, radius = at.translation, at.point((size[0], 0.0, 0.0)), size[1] / 2
    along = tuple(b - a for a, b in zip(begin, end, strict=True))
    return rerun.Arrows3D(
        origins=[begin], vectors=[along], radii=radius, colors=colour(message["color"])
    )


def _box(message: Message, at: Transform) -> Any:  # noqa: ANN401
    import rerun

    return rerun.Boxes3D(
        sizes=[_size(message)],
        centers=[at.translation],
        quaternions=[at.rotation],
        colors=colour(message["color"]),
        fill_mode="solid",
    )


def _ball(message: Message, at: Transform) -> Any:  # noqa: ANN401
    import rerun

    return rerun.Ellipsoids3D(
        half_sizes=[[one / 2 for one in _size(message)]],
        centers=[at.translation],
        quaternions=[at.rotation],
        colors=colour(message["color"]),
        fill_mode="solid",
    )


def _cylinder(message: Message, at: Transform) -> Any:  # noqa: ANN401
    import rerun

    size = _size(message)
    return rerun.Cylinders3D(
        lengths=[size[2]],
        radii=[size[0] / 2],
        centers=[at.translation],
        quaternions=[at.rotation],
        colors=colour(message["color"]),
        fill_mode="solid",
    )


def _boxes(message: Message, at: Transform) -> Any:  # noqa: ANN401
    import rerun

    places = _points(message, at)
    return rerun.Boxes3D(
        sizes=[_size(message)] * len(places),
        centers=places,
        quaternions=[at.rotation] * len(places),
        colors=_colours(message, len(places)),
        fill_mode="solid",
    )


def _dots(message: Message, at: Transform) -> Any:  # noqa: ANN401
    import rerun

    places = _points(message, at)
    return rerun.Points3D(
        places, radii=_size(message)[0] / 2, colors=_colours(message, len(places))
    )


def _strip(message: Message, at: Transform) -> Any:  # noqa: ANN401
    import rerun

    return rerun.LineStrips3D(
        [_points(message, at)], radii=_size(message)[0] / 2, colors=colour(message["color"])
    )


def _lines(message: Message, at: Transform) -> Any:  # noqa: ANN401
    import rerun

    ends = _points(message, at)
    pairs = [list(pair) for pair in zip(ends[::2], ends[1::2], strict=False)]
    return rerun.LineStrips3D(
        pairs, radii=_size(message)[0] / 2, colors=_colours(message, len(ends))[::2]
    )


def _text(message: Message, at: Transform) -> Any:  # noqa: ANN401
    import rerun

    return rerun.Points3D(
        [at.translation],
        radii=0.0,
        labels=plain(str(message["text"]), LONGEST),
        show_labels=True,
        colors=colour(message["color"]),
    )


def _triangles(message: Message, at: Transform) -> Any:  # noqa: ANN401
    import rerun

    corners = _points(message, at)
    whole = corners[: len(corners) // 3 * 3]
    return rerun.Mesh3D(vertex_positions=whole, vertex_colors=_colours(message, len(whole)))


def _colours(message: Message, count: int) -> list[tuple[int, int, int, int]]:
    """Return a colour for each point: its own, or that of the marker."""
    own = [colour(one) for one in message["colors"]]
    return own if len(own) == count else [colour(message["color"])] * count


_SHAPES: dict[int, Callable[[Message, Transform], Any]] = {
    0: _arrow,
    1: _box,
    2: _ball,
    3: _cylinder,
    4: _strip,
    5: _lines,
    6: _boxes,
    7: _dots,
    8: _dots,
    9: _text,
    11: _triangles,
}
"""Numbers of the types. Source: `visualization_msgs/msg/Marker.msg`."""

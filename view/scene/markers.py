"""Shapes that nodes draw by themselves: `visualization_msgs/Marker`."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from space.reading.fields import NotDrawnError, listed, whole
from space.reading.markers import MarkerAction, MarkerKind, kind_name, marker_action, marker_key, read_figure
from text.plain import plain
from text.sentences import say
from view.scene.drawn import Drawn, each, frame_name, topic_path
from view.scene.solids import Solids

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from space.reading.markers import MarkerFigure
    from view.scene.drawn import Message

MARKERS = "markers"
"""The root of all markers in the tree of entities."""
LONGEST = 200


def marker(topic: str, message: Message) -> Iterator[Drawn]:
    """Yield what a marker draws, or that it is removed. Raises NotDrawnError."""
    space, number = marker_key(message)
    path = topic_path(MARKERS, topic, plain(space, LONGEST) or "_", str(number))
    action = marker_action(message)
    if action == MarkerAction.DELETE_ALL:
        yield Drawn(topic_path(MARKERS, topic), (), recursive=True)
    elif action == MarkerAction.DELETE:
        yield Drawn(path, (), recursive=True)
    else:
        kind = whole(message, "type")
        if kind not in _SHAPES:
            raise NotDrawnError(say("there is no shape for markers of type {kind}", kind=kind_name(kind)))
        figure = read_figure(message)
        shapes, frame = (_SHAPES[kind](figure),), frame_name(figure.frame)
        yield Drawn(path, shapes, frame=frame, lifetime_s=figure.lifetime_s)


def several(topic: str, message: Message) -> Iterator[Drawn]:
    """Yield what a `MarkerArray` draws. Raises NotDrawnError."""
    return each(listed(message, "markers"), partial(marker, topic))


def _colours(figure: MarkerFigure) -> NDArray[np.uint8]:
    return np.rint(255 * figure.rgba).astype(np.uint8)


def _placed(figure: MarkerFigure) -> NDArray[np.floating]:
    return figure.at.points(figure.points)


def _arrow(figure: MarkerFigure) -> Any:  # noqa: ANN401 - rerun comes without types
    import rerun

    begin, end = figure.at.points(figure.way)
    # Without points, x of the scale is the length.
    wide = figure.size[0] if len(figure.points) > 1 else figure.size[1]
    return rerun.Arrows3D(origins=[begin], vectors=[end - begin], radii=wide / 2, colors=_colours(figure))


def _solid(figure: MarkerFigure) -> Solids:
    middle = np.array([figure.at.translation])
    return Solids(middle, figure.at.rotation, figure.size, _colours(figure))


def _boxes(figure: MarkerFigure) -> Any:  # noqa: ANN401
    return Solids(_placed(figure), figure.at.rotation, figure.size, _colours(figure)).boxes()


def _dots(figure: MarkerFigure) -> Any:  # noqa: ANN401
    import rerun

    return rerun.Points3D(_placed(figure), radii=figure.size[0] / 2, colors=_colours(figure))


def _strip(figure: MarkerFigure) -> Any:  # noqa: ANN401
    places, colours = _placed(figure), _colours(figure)
    if len(colours) > 1:
        return _strips(figure, np.stack([places[:-1], places[1:]], axis=1), colours[1:])
    return _strips(figure, places[None], colours)


def _lines(figure: MarkerFigure) -> Any:  # noqa: ANN401
    return _strips(figure, _placed(figure).reshape(-1, 2, 3), _colours(figure)[::2])


def _strips(figure: MarkerFigure, strips: NDArray[np.floating], colours: NDArray[np.uint8]) -> Any:  # noqa: ANN401
    import rerun

    return rerun.LineStrips3D(strips, radii=figure.size[0] / 2, colors=colours)


def _text(figure: MarkerFigure) -> Any:  # noqa: ANN401
    import rerun

    return rerun.Points3D(
        [figure.at.translation],
        radii=0.0,
        labels=plain(figure.text, LONGEST),
        show_labels=True,
        colors=_colours(figure),
    )


def _triangles(figure: MarkerFigure) -> Any:  # noqa: ANN401
    import rerun

    corners = _placed(figure)
    colours = np.broadcast_to(_colours(figure), (len(corners), 4))
    return rerun.Mesh3D(vertex_positions=corners, vertex_colors=colours)


_SHAPES: dict[int, Callable[[MarkerFigure], Any]] = {
    MarkerKind.ARROW: _arrow,
    MarkerKind.CUBE: lambda figure: _solid(figure).boxes(),
    MarkerKind.SPHERE: lambda figure: _solid(figure).ellipsoids(),
    MarkerKind.CYLINDER: lambda figure: _solid(figure).cylinders(),
    MarkerKind.LINE_STRIP: _strip,
    MarkerKind.LINE_LIST: _lines,
    MarkerKind.CUBE_LIST: _boxes,
    MarkerKind.SPHERE_LIST: _dots,
    MarkerKind.POINTS: _dots,
    MarkerKind.TEXT_VIEW_FACING: _text,
    MarkerKind.TRIANGLE_LIST: _triangles,
}

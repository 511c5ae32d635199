"""Messages as what Rerun draws in space: archetypes at a place in its tree of entities.

A function a kind of message. Those that need what came before are classes.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from graph.pictures.picture import ramp_colours
from space.drawing.paints import Tint
from space.drawing.shapes import Strokes
from space.reading.clouds import cloud_points
from space.reading.fields import NotDrawnError, field, frame, listed, pose, transform, whole
from space.reading.grids import grid_cells
from space.reading.markers import MarkerAction, MarkerKind, kind_name, marker_action, marker_key, read_figure
from space.reading.poses import DrivenTrail, read_path
from space.reading.robot import read_model
from space.reading.scans import read_range, read_sonar, scan_ends
from space.robot_model import Cuboid, Cylinder, Mesh, Sphere
from text.plain import plain
from text.robot import robot
from text.sentences import reason_of, say

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from space.drawing.shapes import Places, Shape
    from space.reading.fields import Drawable
    from space.reading.markers import MarkerFigure
    from space.robot_model import Visual
    from space.transform import Quaternion, Transform, Vector

LONGEST_NAME = 200
IMPLICIT = "tf#"
"""Rerun's own names of frames begin with it."""
WORLD = "tf#/"
"""The frame of the 3D view, in which the roots of the trees of frames are put."""

SPACE = "space"
"""The root of what is drawn in 3D, apart from frames, markers and the robot itself."""

Message: TypeAlias = "Mapping[str, Any]"
"""A decoded message, see `graph.data.Value`."""


@dataclass(frozen=True)
class Drawn:
    """What is logged at one entity; later ones replace it."""

    path: tuple[str, ...]
    shapes: tuple[Any, ...]
    """Archetypes of Rerun."""
    frame: str = ""
    """The frame they are given in, empty for what is in none."""
    static: bool = False
    """Whether it holds for all times, and is kept however long the viewer runs."""
    recursive: bool = False
    """Whether `shapes` is empty and everything below is removed."""
    lifetime_s: float = 0.0
    """After so long it is removed; 0 for what is kept."""


def frame_name(text: object) -> str:
    """Return a frame's name as it is shown, without a leading slash."""
    name = plain(str(text).lstrip("/"), LONGEST_NAME)
    return f"_{name}" if name.startswith(IMPLICIT) else name


def frame_of(message: Message) -> str:
    """Return the frame in the header of a message. Raises NotDrawnError without one."""
    return frame_name(frame(message))


def each(parts: Iterable[Message], read: Callable[[Message], Iterator[Drawn]]) -> Iterator[Drawn]:
    """Yield what every part draws. Raises NotDrawnError at the end, if one draws nothing."""
    fault: NotDrawnError | None = None
    for part in parts:
        try:
            yield from read(part)
        except NotDrawnError as error:  # noqa: PERF203
            fault = error
    if fault is not None:
        raise fault


def topic_path(root: str, topic: str, *more: str) -> tuple[str, ...]:
    """Return the entity of a topic below `root`."""
    return (root, *(part for part in topic.split("/") if part), *more)


# ---------------------------------------------------------------- frames

FRAMES = "frames"
"""The root of all frames in the tree of entities."""
AXIS_M = 0.08


class Frames:
    """All frames that have been heard of."""

    def __init__(self) -> None:
        self._parents: dict[str, str] = {}
        self._shown: set[str] = set()

    def moved(self, topic: str, message: Message) -> Iterator[Drawn]:
        """Yield the transforms of a message of /tf. Raises NotDrawnError."""
        del topic
        return each(listed(message, "transforms"), partial(self._joined, static=False))

    def fixed(self, topic: str, message: Message) -> Iterator[Drawn]:
        """Yield those of /tf_static, which hold for all times. Raises NotDrawnError."""
        del topic
        return each(listed(message, "transforms"), partial(self._joined, static=True))

    def need(self, frame: str) -> list[Drawn]:
        """Return what puts a frame into the view that no transform has named so far."""
        return [*self._axes(frame), _root(frame)] if frame not in self._shown else []

    def roots(self) -> list[Drawn]:
        """Return what keeps the roots in the view: told again, as a viewer forgets what is old."""
        return [_root(frame) for frame in sorted(self._shown - self._parents.keys())]

    def _joined(self, value: Message, *, static: bool) -> Iterator[Drawn]:
        import rerun

        parent = frame_name(field(value, "header.frame_id"))
        child = frame_name(field(value, "child_frame_id"))
        self._check(parent, child)
        try:
            at = transform(value, "transform")
        except NotDrawnError as error:
            raise NotDrawnError(
                say("{child} in {parent}: {reason}", child=child, parent=parent, reason=reason_of(error))
            ) from None
        self._parents[child] = parent
        place = rerun.Transform3D(
            translation=at.translation, quaternion=at.rotation, parent_frame=parent, child_frame=child
        )
        yield from self.need(parent)
        yield from self._axes(child)
        yield Drawn((FRAMES, child), (place,), static=static)

    def _check(self, parent: str, child: str) -> None:
        if not parent or not child or parent == child:
            raise NotDrawnError(
                say("a transform from '{parent}' to '{child}' joins no two frames", parent=parent, child=child)
            )
        if self._would_close_a_loop(parent, child):
            raise NotDrawnError(
                say(
                    "{child} in {parent} closes a loop of frames: nobody knows where they are",
                    child=child,
                    parent=parent,
                )
            )

    def _would_close_a_loop(self, parent: str, child: str) -> bool:
        above: str | None = parent
        while above is not None and above != child:
            above = self._parents.get(above)
        return above == child

    def _axes(self, frame: str) -> Iterator[Drawn]:
        import rerun

        if frame not in self._shown:
            self._shown.add(frame)
            axes = rerun.TransformAxes3D(AXIS_M, show_frame=True)
            yield Drawn((FRAMES, frame), (axes,), frame=frame, static=True)


def newest_of(messages: Sequence[Message]) -> Message:
    """Return one message with the newest transform of every frame in these, oldest first."""
    found = {str(one["child_frame_id"]): one for message in messages for one in message["transforms"]}
    return {"transforms": list(found.values())}


def _root(frame: str) -> Drawn:
    import rerun

    place = rerun.Transform3D(parent_frame=WORLD, child_frame=frame)
    return Drawn((FRAMES, frame), (place,))


# ---------------------------------------------------------------- clouds, scans, maps

MOST_POINTS = 100_000
"""More are thinned out: at ten messages a second they are 12 MB/s already."""
POINT_M = 0.01
RED = (230, 60, 60)


def cloud(topic: str, message: Message) -> Iterator[Drawn]:
    """Yield a `sensor_msgs/PointCloud2` in its own colours, or those of intensity or height.

    Raises NotDrawnError.
    """
    import numpy as np
    import rerun

    found = cloud_points(message, MOST_POINTS)
    colours = found.rgb
    if colours is None:
        colours = ramp_colours()[(255 * found.shares).astype(np.uint8)]
    shape = rerun.Points3D(found.places, colors=colours, radii=POINT_M)
    yield Drawn(topic_path(SPACE, topic), (shape,), frame=frame_of(message))


def scan(topic: str, message: Message) -> Iterator[Drawn]:
    """Yield a `sensor_msgs/LaserScan` in its plane, only what is between its limits.

    Raises NotDrawnError.
    """
    import rerun

    shape = rerun.Points3D(scan_ends(message), colors=RED, radii=2 * POINT_M)
    yield Drawn(topic_path(SPACE, topic), (shape,), frame=frame_of(message))


def grid(topic: str, message: Message) -> Iterator[Drawn]:
    """Yield a map in RViz's colours. Raises NotDrawnError."""
    import rerun

    found = grid_cells(message)
    height, width = found.cells.shape
    shape = rerun.GridMap(
        # A picture begins at the top, a map at the bottom.
        data=found.cells[::-1].tobytes(),
        format=rerun.components.ImageFormat(width=width, height=height, color_model="L", channel_datatype="U8"),
        cell_size=found.cell_m,
        translation=found.origin.translation,
        quaternion=found.origin.rotation,
        colormap=rerun.components.Colormap.RvizMap,
        opacity=0.8,
    )
    yield Drawn(topic_path(SPACE, topic), (shape,), frame=frame_of(message))


# ---------------------------------------------------------------- lines: poses, ways, cones

COLOURS: dict[int, tuple[int, int, int]] = {Tint.MUTED: (120, 120, 120), Tint.WARN: (80, 200, 255)}
GREEN = (60, 220, 90)
LINE_M = 0.01


def lines(shapes: Iterable[Shape], radius_m: float = LINE_M) -> Any:  # noqa: ANN401
    """Return the strokes of these shapes, each of one tint."""
    import rerun

    strips: list[Places] = []
    colours: list[tuple[int, int, int]] = []
    for shape in shapes:
        if isinstance(shape, Strokes):
            assert isinstance(shape.paint, int)
            pieces = _pieces(shape)
            strips += pieces
            colours += [COLOURS.get(shape.paint, GREEN)] * len(pieces)
    return rerun.LineStrips3D(strips, colors=colours, radii=radius_m)


def _pieces(strokes: Strokes) -> list[Places]:
    """Return lines from point to point, each as long as a stroke begins where one has ended."""
    if not len(strokes.starts):
        return []
    torn = np.flatnonzero((strokes.ends[:-1] != strokes.starts[1:]).any(axis=1)) + 1
    both = zip(np.split(strokes.starts, torn), np.split(strokes.ends, torn), strict=True)
    return [np.concatenate([starts[:1], ends]) for starts, ends in both]


ARROW_M = 0.3
ORANGE = (255, 160, 40)


def posed(topic: str, message: Message) -> Iterator[Drawn]:
    """Yield a `PoseStamped`, or one with a covariance, as an arrow along its x.

    Raises NotDrawnError.
    """
    where = "pose.pose" if "pose" in field(message, "pose") else "pose"
    yield _arrows(topic, frame_of(message), [pose(message, where)])


def many(topic: str, message: Message) -> Iterator[Drawn]:
    """Yield a `PoseArray` as arrows. Raises NotDrawnError."""
    found = [pose({"pose": one}, "pose") for one in listed(message, "poses")]
    yield _arrows(topic, frame_of(message), found)


def path(topic: str, message: Message) -> Iterator[Drawn]:
    """Yield a `nav_msgs/Path` as a line. Raises NotDrawnError, also for poses that are left out."""
    found = read_path(message)
    yield Drawn(topic_path(SPACE, topic), (lines(found.shapes),), frame=frame_of(message))
    if found.remark:
        raise NotDrawnError(found.remark)


class Trails:
    """The way of every odometry, since the viewer opened."""

    def __init__(self) -> None:
        self._trails: dict[str, DrivenTrail] = {}

    def read(self, topic: str, message: Message) -> Iterator[Drawn]:
        """Yield a `nav_msgs/Odometry` as an arrow, and its trail if that has grown.

        Raises NotDrawnError.
        """
        frame, at = frame_of(message), pose(message, "pose.pose")
        yield _arrows(topic, frame, [at])
        trail = self._trails.setdefault(topic, DrivenTrail())
        if trail.add(frame, at.translation):
            entity = topic_path(SPACE, topic, "trail")
            yield Drawn(entity, (lines([trail.line()]),), frame=frame)


def _arrows(topic: str, frame: str, poses: Sequence[Transform]) -> Drawn:
    """Return an arrow along the x of each pose."""
    import rerun

    shape = rerun.Arrows3D(
        origins=[one.translation for one in poses],
        vectors=[(one.matrix()[:3, 0] * ARROW_M) for one in poses],
        colors=ORANGE,
        radii=0.02,
    )
    return Drawn(topic_path(SPACE, topic), (shape,), frame=frame)


CONE_M = 0.005


def cone(topic: str, message: Message) -> Iterator[Drawn]:
    """Yield a `sensor_msgs/Range`, along x. Raises NotDrawnError."""
    yield _cone(topic, read_range(message))


def ray(topic: str, message: Message) -> Iterator[Drawn]:
    """Yield the `std_msgs/Float32` of a sonar, nothing for any other. Raises NotDrawnError."""
    if topic in robot().frames:
        yield _cone(topic, read_sonar(message, robot().frames[topic]))


def _cone(topic: str, found: Drawable) -> Drawn:
    shape = lines(found.shapes, CONE_M)
    return Drawn(topic_path(SPACE, topic), (shape,), frame=frame_name(found.frame))


# ---------------------------------------------------------------- solid things: robot and markers


@dataclass(frozen=True, eq=False)
class Solids:
    """Where they are, and how large."""

    middles: NDArray[np.floating]
    """Shape (n, 3)."""
    rotation: Quaternion
    size_m: Vector
    rgba: NDArray[np.uint8]
    """A row for each, or one for all, 0 to 255."""

    def boxes(self) -> Any:  # noqa: ANN401
        import rerun

        return rerun.Boxes3D(sizes=self._each(self.size_m), **self._placed())

    def ellipsoids(self) -> Any:  # noqa: ANN401
        """Return ellipsoids, whose diameters their size is."""
        import rerun

        return rerun.Ellipsoids3D(half_sizes=self._each(self.size_m) / 2, **self._placed())

    def cylinders(self) -> Any:  # noqa: ANN401
        """Return cylinders about z, round though x and y of their size may differ."""
        import rerun

        wide, _, high = self._each(self.size_m).T
        return rerun.Cylinders3D(lengths=high, radii=wide / 2, **self._placed())

    def _each(self, numbers: Vector | Quaternion) -> NDArray[np.float64]:
        return np.tile(numbers, (len(self.middles), 1))

    def _placed(self) -> dict[str, Any]:
        return {
            "centers": self.middles,
            "quaternions": self._each(self.rotation),
            "colors": self.rgba,
            "fill_mode": "solid",
        }


ROBOT = "robot"
"""The root of the robot's links in the tree of entities."""
GREY = (0.7, 0.7, 0.7, 1.0)


class RobotShapes:
    """The links of the robot that was described last."""

    def __init__(self) -> None:
        self._text = ""
        self._drawn: list[Drawn] = []

    def read(self, topic: str, message: Message) -> Iterator[Drawn]:
        """Yield the links of a robot, apart from meshes, whose files are not read.

        Raises NotDrawnError if the text describes no robot.
        """
        del topic
        text = field(message, "data")
        if text == self._text:
            return
        model = read_model(text)
        self._text = text
        self._drawn = [
            Drawn((ROBOT, frame_name(name), str(number)), (_shape(visual),), frame_name(name))
            for name, link in model.links.items()
            for number, visual in enumerate(link.visuals)
            if not isinstance(visual.shape, Mesh)
        ]
        # The robot before it may have had other links.
        yield Drawn((ROBOT,), (), recursive=True)
        yield from self._drawn

    def again(self) -> list[Drawn]:
        """Return them again, as a viewer forgets what is old."""
        return self._drawn


def _shape(visual: Visual) -> Any:  # noqa: ANN401
    at, shape = visual.origin, visual.shape
    colour = np.rint(255 * np.array([visual.colour or GREY])).astype(np.uint8)
    solids = partial(Solids, np.array([at.translation]), at.rotation, rgba=colour)
    if isinstance(shape, Cuboid):
        return solids(shape.size_m).boxes()
    assert isinstance(shape, (Cylinder, Sphere))
    wide = 2 * shape.radius_m
    if isinstance(shape, Cylinder):
        return solids((wide, wide, shape.length_m)).cylinders()
    return solids((wide, wide, wide)).ellipsoids()


MARKERS = "markers"
"""The root of all markers in the tree of entities."""


def marker(topic: str, message: Message) -> Iterator[Drawn]:
    """Yield what a marker draws, or that it is removed. Raises NotDrawnError."""
    space, number = marker_key(message)
    path = topic_path(MARKERS, topic, plain(space, LONGEST_NAME) or "_", str(number))
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


def _arrow(figure: MarkerFigure) -> Any:  # noqa: ANN401
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
        labels=plain(figure.text, LONGEST_NAME),
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

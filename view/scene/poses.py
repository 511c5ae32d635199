"""Where something is, was, or is to be: poses, odometry, ways."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from view.scene.clouds import SPACE
from view.scene.drawn import Drawn, topic_path
from view.scene.geometry import frame_of, pose, vector

if TYPE_CHECKING:
    from collections.abc import Sequence

    from space.transform import Transform, Vector
    from view.scene.drawn import Message

ARROW_M = 0.3
AHEAD: Vector = (ARROW_M, 0.0, 0.0)
ORANGE, GREEN = (255, 160, 40), (60, 220, 90)


def posed(topic: str, message: Message) -> list[Drawn]:
    """Return a `PoseStamped`, or one with a covariance, as an arrow along its x."""
    value = message["pose"]
    return [arrows(topic, frame_of(message), [pose(value.get("pose", value))])]


def many(topic: str, message: Message) -> list[Drawn]:
    """Return a `PoseArray` as arrows."""
    return [arrows(topic, frame_of(message), [pose(one) for one in message["poses"]])]


def path(topic: str, message: Message) -> list[Drawn]:
    """Return a `nav_msgs/Path` as a line, in the frame of its own header."""
    points = [vector(one["pose"]["position"]) for one in message["poses"]]
    return [line(topic_path(SPACE, topic), frame_of(message), points)]


def arrows(topic: str, frame: str, poses: Sequence[Transform]) -> Drawn:
    """Return an arrow along the x of each pose."""
    import rerun

    shape = rerun.Arrows3D(
        origins=[one.translation for one in poses],
        vectors=[_difference(one.point(AHEAD), one.translation) for one in poses],
        colors=ORANGE,
        radii=0.02,
    )
    return Drawn(topic_path(SPACE, topic), (shape,), frame=frame)


def line(path: tuple[str, ...], frame: str, points: Sequence[Vector]) -> Drawn:
    """Return a line through these points, broken where one is no place."""
    import rerun

    pieces: list[list[Any]] = [[]]
    for point in points:
        if all(map(math.isfinite, point)):
            pieces[-1].append(point)
        elif pieces[-1]:
            pieces.append([])
    shape = rerun.LineStrips3D([one for one in pieces if len(one) > 1], colors=GREEN, radii=0.01)
    return Drawn(path, (shape,), frame=frame)


def _difference(one: Vector, other: Vector) -> Vector:
    return one[0] - other[0], one[1] - other[1], one[2] - other[2]

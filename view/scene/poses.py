"""Where something is, was, or is to be: poses, odometry, ways."""

from __future__ import annotations

from typing import TYPE_CHECKING

from space.reading.fields import NotDrawnError, field, listed, pose
from space.reading.poses import DrivenTrail, read_path
from view.scene.drawn import SPACE, Drawn, frame_of, topic_path
from view.scene.lines import lines

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from space.transform import Transform
    from view.scene.drawn import Message

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

"""Distances as what they mean: the cone of a range finder or of a sonar."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robot.topics import SONAR_FRAMES
from space.reading.scans import read_range, read_sonar
from view.scene.drawn import SPACE, Drawn, frame_name, topic_path
from view.scene.lines import lines

if TYPE_CHECKING:
    from collections.abc import Iterator

    from space.reading.fields import Drawable
    from view.scene.drawn import Message

RADIUS_M = 0.005


def cone(topic: str, message: Message) -> Iterator[Drawn]:
    """Yield a `sensor_msgs/Range`, along x. Raises NotDrawnError."""
    yield _cone(topic, read_range(message))


def ray(topic: str, message: Message) -> Iterator[Drawn]:
    """Yield the `std_msgs/Float32` of a sonar, nothing for any other. Raises NotDrawnError."""
    if topic in SONAR_FRAMES:
        yield _cone(topic, read_sonar(message, SONAR_FRAMES[topic]))


def _cone(topic: str, found: Drawable) -> Drawn:
    shape = lines(found.shapes, RADIUS_M)
    return Drawn(topic_path(SPACE, topic), (shape,), frame=frame_name(found.frame))

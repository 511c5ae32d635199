"""Distances as what they mean: the cone of a range finder, the ray of a sonar."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from robot.topics import SONAR_FRONT, SONAR_REAR
from view.scene.clouds import SPACE
from view.scene.drawn import Drawn, topic_path
from view.scene.geometry import frame_of

if TYPE_CHECKING:
    from view.scene.drawn import Message

SONARS = {SONAR_FRONT: "sonar_front_link", SONAR_REAR: "sonar_rear_link"}
"""A bare number has no header: the frames are those of lesson 6."""
RIM = 24
"""Corners of a cone's rim."""
COLOUR = (80, 200, 255)


def cone(topic: str, message: Message) -> list[Drawn]:
    """Return a `sensor_msgs/Range`: along x, nothing for a distance that is none."""
    half = float(message["field_of_view"]) / 2
    distance = float(message["range"])
    wide = math.isfinite(half) and 0 < half < math.pi / 2
    return [_lines(topic, frame_of(message), distance, half if wide else 0.0)]


def ray(topic: str, message: Message) -> list[Drawn]:
    """Return the `std_msgs/Float32` of a sonar, nothing for any other."""
    frame = SONARS.get(topic)
    return [_lines(topic, frame, float(message["data"]), 0.0)] if frame else []


def _lines(topic: str, frame: str, distance: float, half_rad: float) -> Drawn:
    import rerun

    seen = math.isfinite(distance) and distance > 0
    strips = _strips(distance, half_rad) if seen else []
    shape = rerun.LineStrips3D(strips, colors=COLOUR, radii=0.005)
    return Drawn(topic_path(SPACE, topic), (shape,), frame=frame)


def _strips(distance: float, half_rad: float) -> list[list[tuple[float, float, float]]]:
    """Return the rim at this distance, and lines to it."""
    tip = (0.0, 0.0, 0.0)
    if not half_rad:
        return [[tip, (distance, 0.0, 0.0)]]
    radius, along = distance * math.sin(half_rad), distance * math.cos(half_rad)
    rim = [
        (along, radius * math.cos(turn), radius * math.sin(turn))
        for turn in (math.tau * index / RIM for index in range(RIM + 1))
    ]
    return [rim, *([tip, corner] for corner in rim[: -1 : RIM // 6])]

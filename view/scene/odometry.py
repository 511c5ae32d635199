"""Odometry: where the robot is, and the way that it has come."""

from __future__ import annotations

import math
from collections import deque
from typing import TYPE_CHECKING

from view.scene.clouds import SPACE
from view.scene.drawn import topic_path
from view.scene.geometry import frame_of, pose
from view.scene.poses import arrows, line

if TYPE_CHECKING:
    from space.transform import Vector
    from view.scene.drawn import Drawn, Message

STEP_M = 0.02
"""The trail grows by points that are at least this far apart."""
LONGEST = 2000
"""Points of a trail."""


class Trails:
    """The way of every odometry, since the viewer opened."""

    def __init__(self) -> None:
        self._trails: dict[tuple[str, str], deque[Vector]] = {}

    def read(self, topic: str, message: Message) -> list[Drawn]:
        """Return a `nav_msgs/Odometry` as an arrow, and its trail if that has grown."""
        frame = frame_of(message)
        now = pose(message["pose"]["pose"])
        trail = self._trails.setdefault((topic, frame), deque(maxlen=LONGEST))
        drawn = [arrows(topic, frame, [now])]
        if not trail or math.dist(trail[-1], now.translation) >= STEP_M:
            trail.append(now.translation)
            drawn.append(line(topic_path(SPACE, topic, "trail"), frame, list(trail)))
        return drawn

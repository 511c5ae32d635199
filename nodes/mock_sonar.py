"""A simulated ToF sonar: publishes a distance in metres.

By REP-117, +inf means "nothing in range" (`value:=.inf` makes it constant) and nan means "no valid
reading" (`dropout` adds some). Three patterns: random distances as in the course, a sweep back and
forth, and a constant.
"""

from __future__ import annotations

import math
import random
import time
from collections.abc import Mapping
from typing import Any

from std_msgs.msg import Float32

from nodes.parts.node import DEPTH, Choice, LessonNode, Number, Text, change_period
from nodes.parts.runner import run
from robot.topics import SONAR_FRONT
from text.i18n import N_

_STARTED = N_("The sonar publishes {topic}")
_DISTANCE = N_("Distance {metres:.2f} m")
_ORDER = N_("parameter min_distance is {min_distance:g}, but must be below max_distance {max_distance:g}")
_LOG_EVERY_S = 0.9


class MockSonar(LessonNode):
    """Publishes distances by a pattern."""

    NAME = "mock_sonar_front"
    topic = Text(SONAR_FRONT, "Where the distance is published", fixed=True)
    rate = Number(1.0, "Readings a second", low=0.1, high=200.0, unit="Hz")
    pattern = Choice("random", "How the distance changes", choices=("random", "sweep", "constant"))
    min_distance = Number(0.2, "Nearest distance", low=0.0, high=100.0, unit="m")
    max_distance = Number(3.0, "Farthest distance", low=0.0, high=100.0, unit="m")
    value = Number(1.5, "Distance of the constant pattern", high=math.inf, unit="m")
    sweep_period = Number(10.0, "Period of the sweep", low=0.1, high=3600.0, unit="s")
    noise = Number(0.0, "Standard deviation added to each reading", high=10.0, unit="m")
    dropout = Number(0.0, "Share of readings that are nan instead", high=1.0)

    def __init__(self) -> None:
        super().__init__()
        self._random = random.Random()
        self._began_s = time.monotonic()
        topic = self.topic
        self._publisher = self.create_publisher(Float32, topic, DEPTH)
        self._timer = self.every(1.0 / self.rate, self._tick)
        self.say.info(_STARTED, topic=topic)

    def contradiction(self, values: Mapping[str, Any]) -> str | None:
        """Refuse a minimum that is not below the maximum."""
        return None if float(values["min_distance"]) < float(values["max_distance"]) else _ORDER

    def parameters_changed(self) -> None:
        """Apply the new rate."""
        change_period(self._timer, 1.0 / self.rate)

    def _tick(self) -> None:
        metres = self._distance()
        self._publisher.publish(Float32(data=metres))
        self.say.info(_DISTANCE, every_s=_LOG_EVERY_S, metres=metres)

    def _distance(self) -> float:
        if self._random.random() < self.dropout:
            return math.nan
        noise = self._random.gauss(0.0, self.noise)
        return max(0.0, self._pattern() + noise)

    def _pattern(self) -> float:
        if self.pattern == "constant":
            return self.value
        low, high = self.min_distance, self.max_distance
        if self.pattern == "random":
            return self._random.uniform(low, high)
        turns = (time.monotonic() - self._began_s) / self.sweep_period
        return high - (high - low) * (1.0 - math.cos(2.0 * math.pi * turns)) / 2.0


if __name__ == "__main__":
    raise SystemExit(run(MockSonar))

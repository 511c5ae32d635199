"""What the safety node knows: its sensors, what each reading means, and the state of its gate."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import NamedTuple

from nodes.parts.commands import Refusal
from robot.safety.distance import RangeState, Reading, SafetyZone, Shares, range_state, share
from robot.safety.several import LowestReading


class SensorResult(NamedTuple):
    """The result of one sensor."""

    place: str
    """`front` or `rear`."""
    state: RangeState
    reading: Reading
    share: float
    """The share of the requested speed that is allowed that way, 0 to 1."""
    too_rare: tuple[str, ...] = ()
    """Which of several publishers has fallen silent; one of them if there are more."""


class DistanceSensor:
    """The current state of one distance sensor."""

    def __init__(self, place: str) -> None:
        self._place = place
        self._readings = LowestReading(time.monotonic())

    def see(self, distance_m: float, *, number: int = 0, publishers: int = 1) -> None:
        """Add a new reading, its number at its publisher, and how many publishers there are."""
        self._readings.see(distance_m, time.monotonic(), number=number, publishers=publishers)

    def are(self, publishers: Mapping[bytes, str]) -> None:
        """Say which publishers there are, by identifier, and the names of their nodes."""
        self._readings.are(publishers, time.monotonic())

    def result(self, zone: SafetyZone) -> SensorResult:
        now_s = time.monotonic()
        reading: Reading = self._readings.reading(now_s, zone.stale_after_s)
        state = range_state(reading, zone.critical_m, zone.stale_after_s)
        part = share(reading, zone)
        if state == RangeState.FREE and not part:
            # At the critical distance itself, if it slows before that: nothing is let through.
            state = RangeState.CLOSE
        too_rare = self._readings.too_rare(now_s, zone.stale_after_s)
        return SensorResult(self._place, state, reading, part, too_rare)


class DistanceSensors:
    """The sensor in front, and the one behind if there is one."""

    def __init__(self, *, rear: bool) -> None:
        self.front = DistanceSensor("front")
        self.rear = DistanceSensor("rear") if rear else None

    def results(self, zone: SafetyZone) -> tuple[SensorResult, ...]:
        """Return the current result of each, the front first."""
        return tuple(sensor.result(zone) for sensor in (self.front, self.rear) if sensor is not None)


def shares(results: tuple[SensorResult, ...]) -> Shares:
    """Return the allowed shares each way; without a rear sensor, backing off is unrestricted."""
    return Shares(*(result.share for result in results))


class GateSnapshot(NamedTuple):
    """The current state of the gate."""

    source: str = ""
    """The source that drives, empty if none does."""
    ignored: str = ""
    """The sources ignored in the last second."""
    asked_m_s: float = 0.0
    allowed: float = 1.0
    """The share of that which passes, 0 to 1; for zero speed, the forward share."""
    age_s: float | None = None
    """Age of the newest active command."""
    refused: Refusal | None = None
    """Recently refused commands."""

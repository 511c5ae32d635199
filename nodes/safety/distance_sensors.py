"""The sensors of the safety node: the newest reading of each, and what it means."""

from __future__ import annotations

import time
from typing import NamedTuple

from robot.safety.distance import Reading, SafetyZone, Shares, Sight, look, share


class View(NamedTuple):
    """The result of one sensor."""

    place: str
    """`front` or `rear`."""
    sight: Sight
    reading: Reading
    share: float
    """The share of the requested speed that is allowed that way, 0 to 1."""


class DistanceSensor:
    """The current state of one distance sensor."""

    def __init__(self, place: str) -> None:
        self._place = place
        self._distance_m: float | None = None
        self._seen_s = time.monotonic()

    def see(self, distance_m: float) -> None:
        """Add a new reading."""
        self._distance_m = distance_m
        self._seen_s = time.monotonic()

    @property
    def reading(self) -> Reading:
        """Return the newest reading and its age."""
        return Reading(self._distance_m, time.monotonic() - self._seen_s)

    def view(self, zone: SafetyZone) -> View:
        """Return its current result."""
        reading = self.reading
        sight = look(reading, zone.critical_m, zone.stale_after_s)
        part = share(reading, zone)
        if sight == Sight.FREE and not part:
            # At the critical distance itself, if it slows before that: nothing is let through.
            sight = Sight.CLOSE
        return View(self._place, sight, reading, part)


class Eyes:
    """The sensor in front, and the one behind if there is one."""

    def __init__(self, *, rear: bool) -> None:
        self.front = DistanceSensor("front")
        self.rear = DistanceSensor("rear") if rear else None

    def views(self, zone: SafetyZone) -> tuple[View, ...]:
        """Return the current result of each, the front first."""
        return tuple(eye.view(zone) for eye in (self.front, self.rear) if eye is not None)


def shares(views: tuple[View, ...]) -> Shares:
    """Return the allowed shares each way; without a rear sensor, backing off is unrestricted."""
    return Shares(*(view.share for view in views))

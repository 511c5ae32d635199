"""Where the head looks, read from a JointState."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from robot.joints import HEAD_PAN, HEAD_TILT
from text.figures import whole
from text.i18n import _

LIMIT_DEG = 90.0
SAME_WITHIN_DEG = 0.5


@dataclass(frozen=True)
class HeadReading:
    """Angles in degrees; positive is left and up."""

    pan_deg: float
    tilt_deg: float

    @property
    def pan_words(self) -> str:
        return _words(self.pan_deg, _("{degrees}° left"), _("{degrees}° right"))

    @property
    def tilt_words(self) -> str:
        return _words(self.tilt_deg, _("{degrees}° up"), _("{degrees}° down"))

    @property
    def is_known(self) -> bool:
        """Whether both angles are known: servos have none before they are first moved."""
        return math.isfinite(self.pan_deg) and math.isfinite(self.tilt_deg)

    def near(self, other: HeadReading) -> bool:
        """Whether the two are the same except for rounding."""
        pan, tilt = self.pan_deg - other.pan_deg, self.tilt_deg - other.tilt_deg
        return abs(pan) < SAME_WITHIN_DEG and abs(tilt) < SAME_WITHIN_DEG


def _words(degrees: float, plus: str, minus: str) -> str:
    if not math.isfinite(degrees):
        return "---"
    if not round(degrees):
        return "0°"
    return (plus if degrees > 0 else minus).format(degrees=whole(abs(degrees)))


def head_in(value: Mapping[str, Any]) -> HeadReading | None:
    """Read a sensor_msgs/JointState in radians; None if it is not about the head.

    A missing joint is read as nan.
    """
    names = [str(name) for name in value.get("name", ())]
    if HEAD_PAN not in names and HEAD_TILT not in names:
        return None
    positions = value.get("position", ())

    def degrees(joint: str) -> float:
        at = names.index(joint) if joint in names else len(positions)
        return math.degrees(float(positions[at])) if at < len(positions) else math.nan

    return HeadReading(degrees(HEAD_PAN), degrees(HEAD_TILT))

"""What measures distances: sensor_msgs/LaserScan and Range, and a sonar's bare number."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from space.drawing.paints import Tint
from space.drawing.shapes import Sign, Speckles, Strokes, places, polyline
from space.reading.fields import Drawable, NotDrawnError, field, frame, number, numbers, stamp_s
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Mapping

    from space.drawing.shapes import Places, Shape

MOST_RAYS = 1_000_000
CONE_SIDES = 12
"""Corners of the far end of a cone."""
WIDEST_RAD = math.pi / 2
NARROWEST_RAD = 0.03
BLIND_M = 0.6
"""Length of the ray of a sonar that measures nothing valid."""
CLEAR_M = 4.0
"""Length of the ray of a sonar in front of which there is nothing, if it does not say how far."""


def read_scan(tree: Mapping[str, Any]) -> Drawable:
    """Return the points where rays ended. Raises NotDrawnError."""
    ends, remark = scan_ends(tree), None
    if not len(ends):
        remark = say("no range is valid, of {count}", count=len(field(tree, "ranges")))
    return Drawable(frame(tree), (Speckles(ends, Tint.BAD),), stamp_s(tree), remark)


def scan_ends(tree: Mapping[str, Any]) -> Places:
    """Return where the rays ended whose ranges are valid. Raises NotDrawnError."""
    ranges = numbers(tree, "ranges")
    first, step = number(tree, "angle_min"), number(tree, "angle_increment")
    least, most = number(tree, "range_min"), _farthest(tree, "range_max")
    if not ranges.size:
        raise NotDrawnError(say("the scan has no ranges"))
    if ranges.size > MOST_RAYS:
        raise NotDrawnError(say("a scan of {count} rays is too large", count=ranges.size))
    with np.errstate(invalid="ignore"):
        valid = np.isfinite(ranges) & (ranges >= least) & (ranges <= most)
    angles = (first + step * np.flatnonzero(valid)).astype(np.float32)
    far = ranges[valid]
    return np.stack([far * np.cos(angles), far * np.sin(angles), np.zeros_like(far)], axis=1)


def _farthest(tree: Mapping[str, Any], path: str) -> float:
    """Return the longest range, which some drivers set to infinity."""
    return math.inf if field(tree, path) == math.inf else number(tree, path)


def read_range(tree: Mapping[str, Any]) -> Drawable:
    """Return the cone of a sensor_msgs/Range along x, as long as the distance. Raises NotDrawnError."""
    opening = abs(number(tree, "field_of_view"))
    half = min(max(opening / 2, NARROWEST_RAD), WIDEST_RAD * 0.95)
    return Drawable(frame(tree), ray(_distance(tree, "range"), half, _farthest(tree, "max_range")))


def read_sonar(tree: Mapping[str, Any], frame_id: str) -> Drawable:
    """Return the ray of a std_msgs/Float32 in metres (REP-117). Raises NotDrawnError."""
    return Drawable(frame_id, ray(_distance(tree, "data"), NARROWEST_RAD, CLEAR_M))


def _distance(tree: Mapping[str, Any], path: str) -> float:
    found = field(tree, path)
    if isinstance(found, bool) or not isinstance(found, (int, float, np.number)):
        raise NotDrawnError(say("{field} is not a number", field=path))
    return float(found)


def ray(distance_m: float, half_rad: float, farthest_m: float) -> tuple[Shape, ...]:
    """Return a cone along x; what REP-117 says of infinity and NaN is shown as well."""
    if math.isnan(distance_m):
        end = (BLIND_M, 0.0, 0.0)
        return Strokes(places((0.0, 0.0, 0.0)), places(end), Tint.MUTED), Sign(end, "?", Tint.WARN)
    clear = math.isinf(distance_m)
    length = min(max(0.0, farthest_m if clear else distance_m), 1e4)
    if math.isinf(length):
        length = CLEAR_M
    paint = Tint.MUTED if clear or distance_m > farthest_m else Tint.WARN
    rim = _rim(length, half_rad)
    sides = rim[:: CONE_SIDES // 4]
    cone = Strokes(np.zeros_like(sides), sides, paint)
    return cone, polyline(np.concatenate([rim, rim[:1]]), paint)


def _rim(length_m: float, half_rad: float) -> Places:
    turn = np.arange(CONE_SIDES) * (2 * np.pi / CONE_SIDES)
    wide = length_m * math.sin(half_rad)
    ahead = np.full(CONE_SIDES, length_m * math.cos(half_rad))
    rim = np.stack([ahead, wide * np.cos(turn), wide * np.sin(turn)], axis=1)
    return rim.astype(np.float32)

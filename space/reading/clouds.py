"""sensor_msgs/PointCloud2: points in any layout of their bytes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from space.drawing.paints import cube, ramp
from space.drawing.shapes import Speckles
from space.reading.fields import Drawable, NotDrawnError, field, frame, is_near, listed, stamp_s, whole
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from space.drawing.shapes import Places

KINDS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}
"""sensor_msgs/PointField.datatype to numpy's."""
FLOATS = {"f4", "f8"}
MOST_POINTS = 20_000_000
MOST_DRAWN = 50_000
"""Of a larger cloud: a terminal has some ten thousand dots."""
COLOURS = ("rgb", "rgba")
STRENGTHS = ("intensity", "intensities", "i", "reflectivity")
SPREAD = (2, 98)
"""Percent of the values between which the ramp goes: a few extremes must not spoil it."""
SAMPLED = 4096


class _CloudColumn(NamedTuple):
    offset: int
    kind: str


@dataclass(frozen=True, eq=False)
class CloudPoints:
    """The points of a cloud that are places, and what colours them: `rgb` or else `shares`."""

    places: Places
    rgb: NDArray[np.uint8] | None
    """Shape (n, 3)."""
    shares: NDArray[np.float32]
    """How large the intensity of each is, or else its height, from 0 to 1; empty beside `rgb`."""


def read_cloud(tree: Mapping[str, Any]) -> Drawable:
    """Return the points of a cloud, coloured by rgb, intensity or height.

    Raises NotDrawnError.
    """
    found, count = cloud_points(tree, MOST_DRAWN), _count(tree)
    paint = ramp(found.shares, 0.0, 1.0) if found.rgb is None else cube(found.rgb)
    remark = None
    if count and not len(found.places):
        remark = say("no point is a place: NaN or too far away, all {count}", count=count)
    return Drawable(frame(tree), (Speckles(found.places, paint),), stamp_s(tree), remark)


def cloud_points(tree: Mapping[str, Any], most: int = MOST_POINTS) -> CloudPoints:
    """Return the points of a cloud, of a large one only `most`, evenly. Raises NotDrawnError."""
    columns = _columns(tree)
    step, count = whole(tree, "point_step"), _count(tree)
    _check_columns(columns, step)
    rows = _points_of(tree, step, count)[:: max(1, math.ceil(count / most))]
    count = len(rows)
    order = ">" if field(tree, "is_bigendian") else "<"

    def column(name: str) -> NDArray[np.generic]:
        offset, kind = columns[name]
        kinds = np.dtype({"names": ["v"], "formats": [order + kind], "offsets": [offset], "itemsize": step})
        return rows.view(kinds)["v"].reshape(-1)

    whole_cloud = np.empty((3, count), dtype=np.float32)
    for axis, name in enumerate("xyz"):
        whole_cloud[axis] = column(name)
    kept = np.flatnonzero(is_near(whole_cloud.T))
    if len(kept) < count:
        whole_cloud = whole_cloud.take(kept, axis=1)
    for name in COLOURS:
        if name in columns and column(name).dtype.itemsize == 4:
            return CloudPoints(whole_cloud.T, _unpacked(column(name)[kept]), whole_cloud[0, :0])
    strength = next((column(name)[kept] for name in STRENGTHS if name in columns), whole_cloud[2])
    return CloudPoints(whole_cloud.T, None, _shares(strength.astype(np.float32)))


def _columns(tree: Mapping[str, Any]) -> dict[str, _CloudColumn]:
    found = {}
    for one in listed(tree, "fields"):
        kind = KINDS.get(whole(one, "datatype"))
        offset = whole(one, "offset")
        if kind is not None and offset >= 0:
            found[str(field(one, "name"))] = _CloudColumn(offset, kind)
    return found


def _check_columns(columns: Mapping[str, _CloudColumn], step: int) -> None:
    if missing := [name for name in "xyz" if name not in columns]:
        names = ", ".join(missing)
        raise NotDrawnError(say("the cloud has no field {names}", names=names))
    for name, column in columns.items():
        if name in "xyz" and column.kind not in FLOATS:
            raise NotDrawnError(say("field {name} of the cloud is neither float32 nor float64", name=name))
        if column.offset + int(column.kind[1]) > step:
            raise NotDrawnError(
                say("field {name} of the cloud ends behind its point_step of {step} bytes", name=name, step=step)
            )


def _count(tree: Mapping[str, Any]) -> int:
    wide, high = whole(tree, "width"), whole(tree, "height")
    count = max(0, wide) * max(0, high)
    if count > MOST_POINTS:
        raise NotDrawnError(say("a cloud of {count} points is too large", count=count))
    return count


def _points_of(tree: Mapping[str, Any], step: int, count: int) -> NDArray[np.uint8]:
    """Return the bytes of all points, one after the other, without what pads the rows."""
    data = field(tree, "data")
    if not isinstance(data, (bytes, bytearray, memoryview)):
        data = bytes(np.asarray(data, dtype=np.uint8))
    wide, high, row_step = whole(tree, "width"), whole(tree, "height"), whole(tree, "row_step")
    # Many drivers of clouds of one row leave row_step at 0.
    row_step = row_step if high > 1 and row_step else wide * step
    needed = row_step * (high - 1) + wide * step if count else 0
    if row_step < wide * step or len(data) < needed:
        raise NotDrawnError(
            say(
                "{count} points of {step} bytes are announced, and {size} bytes have come",
                count=count,
                step=step,
                size=len(data),
            )
        )
    whole_data = np.frombuffer(data, np.uint8)
    if not count:
        return np.zeros((0, step), dtype=np.uint8)
    if row_step == wide * step:
        return whole_data[: count * step].reshape(count, step)
    rows = np.lib.stride_tricks.as_strided(whole_data, (high, wide * step), (row_step, 1), writeable=False)
    return np.ascontiguousarray(rows).reshape(count, step)


def _unpacked(packed: NDArray[np.generic]) -> NDArray[np.uint8]:
    """Return red, green and blue of 0xRRGGBB, which PCL packs into the bits of a float32."""
    bits = packed.astype(packed.dtype.newbyteorder("=")).view(np.uint32)
    return np.stack([bits >> 16, bits >> 8, bits], axis=1).astype(np.uint8)


def _shares(values: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return how large values are among themselves, for a ramp of colours.

    Steps of fixed heights would be few for a table and too many for a house.
    """
    sample = values[:: max(1, len(values) // SAMPLED)]
    sample = sample[np.isfinite(sample)]
    least, most = np.percentile(sample, SPREAD).tolist() if sample.size else (0.0, 0.0)
    if not most > least:
        return np.zeros_like(values)
    shares = (np.nan_to_num(values, posinf=0.0, neginf=0.0) - least) / (most - least)
    return np.clip(shares, 0.0, 1.0)

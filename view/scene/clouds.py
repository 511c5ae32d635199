"""Points that a sensor has seen: `PointCloud2` and `LaserScan`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from text.sentences import say
from view.scene.drawn import Drawn, UnusableMessageError, topic_path
from view.scene.geometry import frame_of

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from view.scene.drawn import Message

SPACE = "space"
"""The root of what is drawn in 3D, apart from frames and the robot itself."""
MOST_POINTS = 100_000
"""More are thinned out: at ten messages a second they are 12 MB/s already."""
KINDS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}
"""Numbers of `sensor_msgs/PointField` to numpy's names."""
COLOURS = ("rgb", "rgba")
RADIUS_M = 0.01


def cloud(topic: str, message: Message) -> list[Drawn]:
    """Return a `sensor_msgs/PointCloud2`, without the points that are none.

    Raises UnusableMessageError if its fields do not fit its data.
    """
    import numpy as np
    import rerun

    frame = frame_of(message)
    rows = _thinned(_rows(message))
    points = np.stack([rows[axis].astype(np.float32) for axis in "xyz"], axis=1)
    seen = np.isfinite(points).all(axis=1)
    points = points[seen]
    named = next((name for name in COLOURS if name in (rows.dtype.names or ())), "")
    colours = _colours(rows[named])[seen] if named else _by_height(points)
    shape = rerun.Points3D(points, colors=colours, radii=RADIUS_M)
    return [Drawn(topic_path(SPACE, topic), (shape,), frame=frame)]


def scan(topic: str, message: Message) -> list[Drawn]:
    """Return a `sensor_msgs/LaserScan` in its plane, only what is between its limits."""
    import numpy as np
    import rerun

    frame = frame_of(message)
    ranges = np.asarray(message["ranges"], np.float64)
    angles = float(message["angle_min"]) + float(message["angle_increment"]) * np.arange(
        len(ranges)
    )
    near, far = float(message["range_min"]), float(message["range_max"])
    seen = np.isfinite(ranges) & np.isfinite(angles) & (ranges >= near) & (ranges <= far)
    ranges, angles = ranges[seen], angles[seen]
    flat = np.zeros_like(ranges)
    points = np.stack([ranges * np.cos(angles), ranges * np.sin(angles), flat], axis=1)
    shape = rerun.Points3D(points, colors=(230, 60, 60), radii=2 * RADIUS_M)
    return [Drawn(topic_path(SPACE, topic), (shape,), frame=frame)]


def _rows(message: Message) -> NDArray[np.void]:
    """Return one record for each point, with its fields by name."""
    import numpy as np

    width, height, step = (int(message[name]) for name in ("width", "height", "point_step"))
    fields = {str(field["name"]): field for field in message["fields"]}
    if missing := [axis for axis in "xyz" if axis not in fields]:
        raise UnusableMessageError(
            say("it has no field {names}: a cloud needs x, y and z", names=", ".join(missing))
        )
    order = ">" if message["is_bigendian"] else "<"
    wanted = [fields[name] for name in (*"xyz", *COLOURS) if name in fields]
    line, data = int(message["row_step"]) or width * step, bytes(message["data"])
    known = all(int(field["datatype"]) in KINDS for field in wanted)
    kinds = [order + KINDS.get(int(field["datatype"]), "u1") for field in wanted]
    offsets = [int(field["offset"]) for field in wanted]
    ends = [at + np.dtype(kind).itemsize for kind, at in zip(kinds, offsets, strict=True)]
    if not known or max(ends) > step or line < width * step:
        raise UnusableMessageError(
            say("its fields do not fit: point_step {step}, row_step {row}", step=step, row=line)
        )
    if len(data) < line * height:
        raise UnusableMessageError(
            say(
                "data has {found} bytes, and {height} rows of {row} need {need}",
                found=len(data),
                height=height,
                row=line,
                need=line * height,
            )
        )
    names = [str(field["name"]) for field in wanted]
    kind = np.dtype({"names": names, "formats": kinds, "offsets": offsets, "itemsize": step})
    # A row may be longer than its points.
    whole = np.frombuffer(data, np.uint8, line * height).reshape(height, line)[:, : width * step]
    rows: NDArray[np.void] = np.ascontiguousarray(whole).reshape(-1).view(kind)
    return rows


def _thinned(rows: NDArray[np.void]) -> NDArray[np.void]:
    return rows[:: max(1, math.ceil(len(rows) / MOST_POINTS))]


def _colours(packed: NDArray[np.generic]) -> NDArray[np.uint8]:
    """Return red, green and blue, shape (n, 3), of 0x00RRGGBB, which PCL writes as float."""
    import numpy as np

    numbers = np.ascontiguousarray(packed).view(f"{packed.dtype.byteorder}u4").astype(np.uint32)
    colours: NDArray[np.uint8] = np.stack([numbers >> 16, numbers >> 8, numbers], 1).astype(
        np.uint8
    )
    return colours


def _by_height(points: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Return a colour for the height of each point, so that a grey cloud has a shape."""
    import numpy as np

    from graph.pictures.picture import ramp_colours

    height = points[:, 2]
    low, high = (float(height.min()), float(height.max())) if len(height) else (0.0, 0.0)
    share = (height - low) / ((high - low) or 1.0)
    colours: NDArray[np.uint8] = ramp_colours()[(255 * share).astype(np.uint8)]
    return colours

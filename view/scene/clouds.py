"""Points that a sensor has seen: `PointCloud2` and `LaserScan`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.pictures.picture import ramp_colours
from space.reading.clouds import cloud_points
from space.reading.scans import scan_ends
from view.scene.drawn import SPACE, Drawn, frame_of, topic_path

if TYPE_CHECKING:
    from collections.abc import Iterator

    from view.scene.drawn import Message

MOST_POINTS = 100_000
"""More are thinned out: at ten messages a second they are 12 MB/s already."""
RADIUS_M = 0.01
RED = (230, 60, 60)


def cloud(topic: str, message: Message) -> Iterator[Drawn]:
    """Yield a `sensor_msgs/PointCloud2` in its own colours, or those of intensity or height.

    Raises NotDrawnError.
    """
    import numpy as np
    import rerun

    found = cloud_points(message, MOST_POINTS)
    colours = found.rgb
    if colours is None:
        colours = ramp_colours()[(255 * found.shares).astype(np.uint8)]
    shape = rerun.Points3D(found.places, colors=colours, radii=RADIUS_M)
    yield Drawn(topic_path(SPACE, topic), (shape,), frame=frame_of(message))


def scan(topic: str, message: Message) -> Iterator[Drawn]:
    """Yield a `sensor_msgs/LaserScan` in its plane, only what is between its limits.

    Raises NotDrawnError.
    """
    import rerun

    shape = rerun.Points3D(scan_ends(message), colors=RED, radii=2 * RADIUS_M)
    yield Drawn(topic_path(SPACE, topic), (shape,), frame=frame_of(message))

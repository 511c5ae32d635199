"""Maps: `nav_msgs/OccupancyGrid`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from text.sentences import say
from view.scene.clouds import SPACE
from view.scene.drawn import Drawn, UnusableMessageError, topic_path
from view.scene.geometry import frame_of, pose

if TYPE_CHECKING:
    from view.scene.drawn import Message


def grid(topic: str, message: Message) -> list[Drawn]:
    """Return a map in RViz's colours; its origin is the corner of its first cell.

    Raises UnusableMessageError if its size does not fit its cells.
    """
    import numpy as np
    import rerun

    info = message["info"]
    width, height, cell_m = int(info["width"]), int(info["height"]), float(info["resolution"])
    cells = np.asarray(message["data"], np.int8)
    if len(cells) != width * height or not width * height:
        raise UnusableMessageError(
            say(
                "the map has {found} cells, and its size is {width} x {height}",
                found=len(cells),
                width=width,
                height=height,
            )
        )
    if not (math.isfinite(cell_m) and cell_m > 0):
        raise UnusableMessageError(
            say("info.resolution has to be above 0: {size}", size=f"{cell_m:g}")
        )
    origin = pose(info["origin"])
    shape = rerun.GridMap(
        # A picture begins at the top, a map at the bottom.
        data=np.flipud(cells.reshape(height, width)).tobytes(),
        format=rerun.components.ImageFormat(
            width=width, height=height, color_model="L", channel_datatype="U8"
        ),
        cell_size=cell_m,
        translation=origin.translation,
        quaternion=origin.rotation,
        colormap=rerun.components.Colormap.RvizMap,
        opacity=0.8,
    )
    return [Drawn(topic_path(SPACE, topic), (shape,), frame=frame_of(message))]

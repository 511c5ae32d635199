"""Maps: `nav_msgs/OccupancyGrid`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from space.reading.grids import grid_cells
from view.scene.drawn import SPACE, Drawn, frame_of, topic_path

if TYPE_CHECKING:
    from collections.abc import Iterator

    from view.scene.drawn import Message


def grid(topic: str, message: Message) -> Iterator[Drawn]:
    """Yield a map in RViz's colours. Raises NotDrawnError."""
    import rerun

    found = grid_cells(message)
    height, width = found.cells.shape
    shape = rerun.GridMap(
        # A picture begins at the top, a map at the bottom.
        data=found.cells[::-1].tobytes(),
        format=rerun.components.ImageFormat(width=width, height=height, color_model="L", channel_datatype="U8"),
        cell_size=found.cell_m,
        translation=found.origin.translation,
        quaternion=found.origin.rotation,
        colormap=rerun.components.Colormap.RvizMap,
        opacity=0.8,
    )
    yield Drawn(topic_path(SPACE, topic), (shape,), frame=frame_of(message))

"""Which types of messages are drawn, and what reads each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from space.reading.clouds import read_cloud
from space.reading.grids import read_grid
from space.reading.markers import MarkerBook
from space.reading.poses import DrivenTrail, read_goal, read_path
from space.reading.scans import read_range, read_scan

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from space.reading.fields import Drawable
    from text.sentences import Words


class LayerReader(Protocol):
    """Takes messages of one topic, and says what they show."""

    def read(self, tree: Mapping[str, Any], now_s: float) -> None:
        """Take a message that has come now. Raises NotDrawnError."""

    def shown(self, now_s: float) -> Sequence[Drawable]:
        """Return what is to be seen now."""

    @property
    def remark(self) -> Words | None:
        """What is not drawn, and why; None if everything is."""

    def clear(self) -> None:
        """Forget all messages."""


class NewestReader:
    """Shows the newest message alone."""

    def __init__(self, read: Callable[[Mapping[str, Any]], Drawable]) -> None:
        self._read = read
        self._newest: Drawable | None = None

    def read(self, tree: Mapping[str, Any], now_s: float) -> None:
        """Take the message in place of the one before, which is gone even if this one is bad."""
        del now_s
        self._newest = None
        self._newest = self._read(tree)

    def shown(self, now_s: float) -> Sequence[Drawable]:
        del now_s
        return () if self._newest is None else (self._newest,)

    @property
    def remark(self) -> Words | None:
        """What of the newest is not drawn."""
        return None if self._newest is None else self._newest.remark

    def clear(self) -> None:
        self._newest = None


@dataclass(frozen=True)
class LayerKind:
    """How messages of one type are read."""

    make: Callable[[], LayerReader]
    every: bool = False
    """Whether every message is needed, rather than only the newest."""
    grows: bool = False
    """Whether it takes all messages that are at hand."""


KINDS: Mapping[str, LayerKind] = {
    "nav_msgs/msg/OccupancyGrid": LayerKind(lambda: NewestReader(read_grid)),
    "sensor_msgs/msg/LaserScan": LayerKind(lambda: NewestReader(read_scan)),
    "sensor_msgs/msg/Range": LayerKind(lambda: NewestReader(read_range)),
    "sensor_msgs/msg/PointCloud2": LayerKind(lambda: NewestReader(read_cloud)),
    "nav_msgs/msg/Path": LayerKind(lambda: NewestReader(read_path)),
    "geometry_msgs/msg/PoseStamped": LayerKind(lambda: NewestReader(read_goal)),
    "nav_msgs/msg/Odometry": LayerKind(lambda: NewestReader(DrivenTrail().read), grows=True),
    "visualization_msgs/msg/Marker": LayerKind(MarkerBook, every=True),
    "visualization_msgs/msg/MarkerArray": LayerKind(MarkerBook, every=True),
}
"""Type of messages to how they are read."""

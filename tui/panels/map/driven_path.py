"""The path that was driven: thinned to what can be seen, bounded in memory, torn at gaps."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tui.panels.dots import Point

LEAST_M = 0.02
"""A shorter way is none yet."""
TORN_M = 0.6
"""A longer one was not driven between two looks: the odometry began anew, or nobody looked."""
MOST = 4000


class DrivenPath:
    """Points in the order in which they were driven, in pieces."""

    def __init__(self) -> None:
        self.pieces: list[list[Point]] = []
        self.length_m = 0.0
        self.revision = 0
        """Changes when older points are no longer what they were."""
        self._least_m = LEAST_M
        self._points = 0
        self._corners: list[Point] = []

    @property
    def bounds(self) -> list[Point]:
        """The corners of the least rectangle around all that was driven; none at first."""
        return self._corners

    def add(self, x_m: float, y_m: float) -> bool:
        """Go on to a place, and tell whether the path has changed."""
        way_m = math.dist(self.pieces[-1][-1], (x_m, y_m)) if self.pieces else math.inf
        if way_m < self._least_m:
            return False
        if way_m > max(TORN_M, 2 * self._least_m):
            self.pieces.append([(x_m, y_m)])
        else:
            self.length_m += way_m
            self.pieces[-1].append((x_m, y_m))
        self._points += 1
        across, up = zip(*self._corners, (x_m, y_m), strict=True)
        self._corners = [(min(across), min(up)), (max(across), max(up))]
        if self._points > MOST:
            self._thin()
        return True

    def clear(self) -> None:
        """Nothing was driven."""
        self.pieces, self.length_m, self._points = [], 0.0, 0
        self._least_m, self._corners = LEAST_M, []
        self.revision += 1

    def _thin(self) -> None:
        """Let every second point go; pieces that were torn off long ago go first."""
        self.pieces = [_halved(piece) for piece in self.pieces[-MOST // 4 :]]
        self._points = sum(map(len, self.pieces))
        self._least_m *= 2
        self.revision += 1


def _halved(piece: list[Point]) -> list[Point]:
    kept = piece[::2]
    return kept if kept[-1] == piece[-1] else [*kept, piece[-1]]

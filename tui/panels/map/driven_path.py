"""The path driven so far: thinned to what is visible, limited in memory, broken at gaps."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tui.panels.dots import Point

LEAST_M = 0.02
"""Shorter distances are not added."""
TORN_M = 0.6
"""A longer distance was not really driven: the odometry was reset, or nobody was looking."""
MOST = 4000


class DrivenPath:
    """The points of the path in order, in pieces."""

    def __init__(self) -> None:
        self.pieces: list[list[Point]] = []
        self.length_m = 0.0
        self.revision = 0
        """Changes when older points have been changed."""
        self._least_m = LEAST_M
        self._points = 0
        self._corners: list[Point] = []

    @property
    def bounds(self) -> list[Point]:
        """Opposite corners of the bounding box of the whole path; none at first."""
        return self._corners

    def add(self, x_m: float, y_m: float) -> bool:
        """Continue to a point; return whether the path has changed."""
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
        self.pieces, self.length_m, self._points = [], 0.0, 0
        self._least_m, self._corners = LEAST_M, []
        self.revision += 1

    def _thin(self) -> None:
        """Drop every second point, and the oldest pieces."""
        self.pieces = [_halved(piece) for piece in self.pieces[-MOST // 4 :]]
        self._points = sum(map(len, self.pieces))
        self._least_m *= 2
        self.revision += 1


def _halved(piece: list[Point]) -> list[Point]:
    kept = piece[::2]
    return kept if kept[-1] == piece[-1] else [*kept, piece[-1]]

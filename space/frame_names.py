"""The frames themselves in the picture: their axes, and names that do not crowd each other."""

from __future__ import annotations

import math
from collections import defaultdict
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from space.drawing.paints import Tint
from space.drawing.shapes import Sign, axes
from text.plain import plain

if TYPE_CHECKING:
    from collections.abc import Sequence

    from space.drawing.camera import SpaceCamera
    from space.drawing.shapes import Shape
    from space.placing import Located

Spot: TypeAlias = "list[float]"
"""Where a frame is in the picture: x and y in dots."""
AXIS_M, LEAST_AXIS_DOTS, MOST_AXIS_DOTS = 0.15, 5.0, 30.0
LONGEST_NAME = 40
JOIN_DOTS, PART_DOTS = 4.0, 7.0
"""Frames that come as close in the picture share a line for their names, until they are as far."""
NAMED_TOGETHER = 2
"""In a line; of more frames it has the first one, and how many others there are."""


class FrameNames:
    """Axes and names; it remembers which frames shared a line, so that none comes and goes."""

    def __init__(self) -> None:
        """Begin without a picture before."""
        self._leaders: dict[str, str] = {}
        """Frame to the first one of its line."""

    def shapes(self, frames: Sequence[Located], camera: SpaceCamera, first: Sequence[str] = ()) -> list[Shape]:
        """Return what is drawn of frames; the names of `first` come first, then in the order given.

        Axes are 0.15 m long, but never too small or too large to be seen.
        """
        size = min(max(AXIS_M * camera.dots_per_m, LEAST_AXIS_DOTS), MOST_AXIS_DOTS)
        shapes: list[Shape] = []
        for one in frames:
            shapes += axes(one.at, size / camera.dots_per_m)
        ranks = {frame: rank for rank, frame in enumerate(dict.fromkeys(first))}
        ordered = sorted(frames, key=lambda one: ranks.get(one.drawable.frame, len(ranks)))
        for line in self._lines(ordered, camera):
            names = [plain(one.drawable.frame, LONGEST_NAME) for one in line]
            text = f"{names[0]} +{len(names) - 1}"
            if len(names) <= NAMED_TOGETHER:
                text = ", ".join(names)
            leader = line[0]
            shapes.append(Sign(leader.at.translation, text, Tint.TEXT, leader.drawable.frame))
        return shapes

    def _lines(self, frames: Sequence[Located], camera: SpaceCamera) -> list[list[Located]]:
        places = np.array([one.at.translation for one in frames]).reshape(-1, 3)
        # What is no place is drawn nowhere, but has to be counted somewhere.
        spots = np.nan_to_num(places @ camera.basis()[:2].T * camera.dots_per_m).tolist()
        lines: dict[str, list[Located]] = {}
        near = _Leaders()
        leaders: dict[str, str] = {}
        for one, spot in zip(frames, spots, strict=True):
            frame = one.drawable.frame
            leader = near.of(self._leaders.get(frame, ""), spot)
            if not leader:
                leader = frame
                near.add(frame, spot)
            leaders[frame] = leader
            lines.setdefault(leader, []).append(one)
        self._leaders = leaders
        return list(lines.values())


class _Leaders:
    """The first frames of lines by where they are, in squares: there may be hundreds."""

    def __init__(self) -> None:
        self._spots: dict[str, Spot] = {}
        self._squares: dict[tuple[int, int], list[str]] = defaultdict(list)

    def add(self, frame: str, spot: Spot) -> None:
        """Let a frame begin a line."""
        self._spots[frame] = spot
        self._squares[_square(spot)].append(frame)

    def of(self, before: str, spot: Spot) -> str:
        """Return in whose line a frame is named that was in that of `before`; empty for none."""
        if before in self._spots and self._apart(before, spot) <= PART_DOTS:
            return before
        column, row = _square(spot)
        close = [
            frame
            for x in (column - 1, column, column + 1)
            for y in (row - 1, row, row + 1)
            for frame in self._squares.get((x, y), ())
            if self._apart(frame, spot) <= JOIN_DOTS
        ]
        return min(close, key=lambda frame: (self._apart(frame, spot), frame), default="")

    def _apart(self, frame: str, spot: Spot) -> float:
        x, y = self._spots[frame]
        return max(abs(x - spot[0]), abs(y - spot[1]))


def _square(spot: Spot) -> tuple[int, int]:
    return math.floor(spot[0] / JOIN_DOTS), math.floor(spot[1] / JOIN_DOTS)

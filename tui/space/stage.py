"""The picture of all layers: placed in the fixed frame, seen by the camera."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from robot.topics import SONAR_FRAMES
from robot.world.world import Body
from space.buffer import NoTransformError, TransformBuffer
from space.drawing.extent import SpaceBox, extent_of
from space.drawing.paints import Tint
from space.drawing.raster import Raster
from space.drawing.scene import draw
from space.drawing.shapes import Strokes
from space.frame_names import FrameNames
from space.placing import Located, Placer, cube_of
from space.transform import Transform
from text.sentences import say
from tui.space.layers import SpaceLayers

if TYPE_CHECKING:
    from collections.abc import Iterable

    from graph.data import FrameRow, GraphUpdate
    from space.drawing.camera import SpaceCamera
    from space.drawing.raster import CellPicture
    from space.drawing.shapes import Shape
    from space.transform import Vector
    from tui.space.aim import Aim

BODY = Body()
BASE = "base_link"
AROUND = 0.05
"""Share of the picture that is left free around everything when it is fitted."""
LEAST_M = 2.0
"""Less than this is never made to fill the picture."""
MESH_DOTS = 16.0
"""The least width of the meshes of the floor."""
MOST_MESHES = 20
SEEN_M = 0.002
"""A smaller move is not drawn."""


def _mounts() -> dict[str, tuple[str, Transform]]:
    """Where the sonars of the course are, for robots that do not publish it."""
    front, rear = SONAR_FRAMES.values()
    ahead, behind = BODY.length_m - BODY.behind_m, -BODY.behind_m
    return {
        front: (BASE, Transform((ahead, 0.0, 0.0))),
        rear: (BASE, Transform.from_rpy((behind, 0.0, 0.0), (0.0, 0.0, math.pi))),
    }


class Stage:
    """What is known of space, and how it is to be seen."""

    def __init__(self) -> None:
        self.buffer = TransformBuffer()
        self.layers = SpaceLayers()
        self.show_frames = True
        self.frames_why = ""
        """Which frames are not joined to the fixed one."""
        self.wanted_fixed = ""
        """The fixed frame that the user has chosen; empty for the robot's root."""
        self.follow = ""
        """The frame that the camera moves with; empty for none."""
        self._followed: Vector | None = None
        """Where it was when the camera was moved last."""
        self.sent: tuple[str, Aim] | None = None
        """The goal published last, and its frame, until the graph shows it."""
        self._placer = Placer(_mounts())
        self._shapes: list[Shape] = []
        self._placed_for: SpaceCamera | None = None
        self._found: list[Located] = []
        self._frames: list[Located] = []
        self._names = FrameNames()
        self._signs: dict[str, int | None] = {}
        """In which rows names were in the last picture."""

    @property
    def fixed(self) -> str:
        """The frame in which everything is drawn; empty while there is none."""
        if self.wanted_fixed in self.buffer.frames:
            return self.wanted_fixed
        return self._placer.root(self.buffer, (one.frame for one in self.layers if one.frame))

    def take(self, update: GraphUpdate, now_s: float) -> bool:
        """Take in an update; return whether layers came or went."""
        self.buffer.add(row.newest for row in update.frames if not row.fault)
        self._drop_frames(update.frames)
        changed = self.layers.see(update)
        for layer in self.layers:
            if layer.on:
                layer.read(update, now_s)
        return changed

    def _drop_frames(self, rows: Iterable[FrameRow]) -> None:
        """Begin anew once frames have gone: the buffer keeps what it knows for ever."""
        there = {row.newest.child for row in rows}
        known = {frame for frame in self.buffer.frames if self.buffer.newest(frame)}
        if there and known - there:
            newest = [row.newest for row in rows if not row.fault]
            self.buffer.clear()
            self.buffer.add(newest)

    def place(self, camera: SpaceCamera, now_s: float) -> bool:
        """Place all layers, and note at each what cannot be placed.

        Return whether anything is to be seen elsewhere than before.
        """
        found: list[Located] = []
        shown = {layer: layer.reader.shown(now_s) if layer.is_drawn else () for layer in self.layers}
        for layer, drawables in shown.items():
            layer.frame = next((one.frame for one in drawables if one.frame), layer.frame)
        # Without /tf the frames of the layers say what the fixed frame is.
        fixed = self.fixed
        for layer, drawables in shown.items():
            located, layer.apart = self._placer.find(self.buffer, fixed, drawables)
            found += located
        frames: list[Located] = []
        self.frames_why = ""
        if self.show_frames and fixed in self.buffer.frames:
            frames, apart = self._placer.frames(self.buffer, fixed)
            if apart:
                names = ", ".join(apart[:3]) + (", …" if len(apart) > 3 else "")
                self.frames_why = say("not joined to {fixed}: {frames}", fixed=fixed, frames=names)
        if camera == self._placed_for and _look_alike(found, self._found) and _look_alike(frames, self._frames):
            return False
        self._placed_for, self._found, self._frames = camera, found, frames
        self._shapes = self._placer.place(found, cube_of(camera))
        self._shapes += self._names.shapes(frames, camera, self._named_first)
        return True

    @property
    def _named_first(self) -> tuple[str, ...]:
        """The frames whose names matter most: what the user has chosen, then what has data."""
        return (self.follow, self.fixed, *(one.frame for one in self.layers if one.on))

    def extent(self) -> SpaceBox | None:
        """Return the box that holds everything placed, with a margin."""
        found = extent_of(self._shapes)
        return None if found is None else found.widened(AROUND, LEAST_M)

    def follow_frame(self, frame: str) -> None:
        """Keep this frame in the middle from now on; none if it is empty."""
        self.follow, self._followed = frame, None

    def followed(self, camera: SpaceCamera) -> SpaceCamera:
        """Return the camera moved as the frame that is followed has moved, if that is known.

        At first the frame gets into the middle; what the user moves afterwards stays so.
        """
        try:
            at = self.buffer.find(self.fixed, self.follow).translation
        except NoTransformError:
            return camera
        before, self._followed = self._followed, at
        if before is None:
            return replace(camera, target=at)
        x, y, z = (middle + now - then for middle, now, then in zip(camera.target, at, before, strict=True))
        return replace(camera, target=(x, y, z))

    def picture(self, camera: SpaceCamera, columns: int, rows: int, aim: Aim | None) -> CellPicture:
        """Return the picture of what was placed last."""
        raster = Raster(columns, rows, self._signs)
        shapes = [*_ground(camera, raster), *self._shapes]
        if self.sent is not None and self.sent[0] == self.fixed:
            shapes += self.sent[1].shapes(camera.dots_per_m)
        if aim is not None:
            shapes += aim.shapes(camera.dots_per_m)
        draw(raster, camera, shapes)
        self._signs = raster.signs.moved
        return raster.cells()


def _look_alike(now: list[Located], before: list[Located]) -> bool:
    return len(now) == len(before) and all(
        one.looks_like(other, SEEN_M) for one, other in zip(now, before, strict=True)
    )


def _ground(camera: SpaceCamera, raster: Raster) -> list[Shape]:
    """The meshes of the floor about the target: without them a perspective has no depth."""
    if not camera.turns:
        return []
    step = 1.0
    while step * camera.dots_per_m < MESH_DOTS:
        step *= 2
    reach = min(raster.width / 2 / camera.dots_per_m / step, MOST_MESHES)
    lines = np.arange(-math.ceil(reach), math.ceil(reach) + 1)
    middle = [round(value / step) for value in camera.target[:2]]
    ends = []
    for side in (lines[0], lines[-1]):
        along = np.full_like(lines, side)
        one = np.stack([lines + middle[0], along + middle[1], 0 * lines], axis=1)
        other = np.stack([along + middle[0], lines + middle[1], 0 * lines], axis=1)
        ends.append((np.concatenate([one, other]) * step).astype(np.float32))
    return [Strokes(ends[0], ends[1], Tint.MUTED)]

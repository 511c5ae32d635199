"""The picture of all layers: placed in the fixed frame, seen by the camera."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

from graph.data import FrameRow, GraphUpdate
from space.buffer import NoTransformError, TransformBuffer
from space.drawing.picture import CellPicture, SpaceBox, SpaceCamera, extent_of, picture
from space.drawing.shapes import Shape, Speckles, places
from space.placing import Placer, frame_shapes
from space.transform import Transform, Vector
from text.robot import robot
from text.sentences import say
from tui.space.layers import SpaceLayers

if TYPE_CHECKING:
    from tui.space.aiming import Aim

BASE = "base_link"
AROUND = 0.05
"""Share of the picture that is left free around everything when it is fitted."""
LEAST_M = 2.0
"""Less than this is never made to fill the picture."""


MOUNTS = {
    frame: (BASE, Transform.from_rpy((ahead_m, 0.0, 0.0), (0.0, 0.0, heading_rad)))
    for frame, (ahead_m, heading_rad) in robot().mounts.items()
}
"""Where the robot's sonars are, as long as it does not publish that."""


class Stage:
    """What is known of space, and how it is to be seen."""

    def __init__(self) -> None:
        self.buffer = TransformBuffer()
        self.layers = SpaceLayers()
        self.show_frames = True
        self.frames_why = ""
        self.wanted_fixed = ""
        """The fixed frame that the user has chosen; empty for the robot's root."""
        self.follow = ""
        """The frame that the camera moves with; empty for none."""
        self._followed: Vector | None = None
        """Where it was when the camera was moved last."""
        self.sent: tuple[str, Aim] | None = None
        """The goal published last, and its frame, until the graph shows it."""
        self._placer = Placer(MOUNTS)
        self._shapes: list[Shape] = []
        self._frames: dict[str, Transform] = {}

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

    def place(self, now_s: float) -> None:
        shown = {layer: layer.reader.shown(now_s) if layer.is_drawn else () for layer in self.layers}
        for layer, drawables in shown.items():
            layer.frame = next((one.frame for one in drawables if one.frame), layer.frame)
        # Without /tf the frames of the layers say what the fixed frame is.
        fixed = self.fixed
        self._shapes, self._frames, self.frames_why = [], {}, ""
        for layer, drawables in shown.items():
            shapes, layer.apart = self._placer.place(self.buffer, fixed, drawables)
            self._shapes += shapes
        if self.show_frames and fixed in self.buffer.frames:
            self._frames, apart = self._placer.frames(self.buffer, fixed)
            if apart:
                names = ", ".join(apart[:3]) + (", …" if len(apart) > 3 else "")
                self.frames_why = say("not joined to {fixed}: {frames}", fixed=fixed, frames=names)

    def extent(self) -> SpaceBox | None:
        """Return the box that holds everything placed, with a margin."""
        origins = places(*(at.translation for at in self._frames.values()))
        found = extent_of([*self._shapes, Speckles(origins)])
        return None if found is None else found.widened(AROUND, LEAST_M)

    def follow_frame(self, frame: str) -> None:
        self.follow, self._followed = frame, None

    def followed(self, camera: SpaceCamera) -> SpaceCamera:
        """Return the camera moved as the frame that is followed has moved, if that is known.

        At first the frame gets into the middle; what the user moves afterwards stays so.
        """
        try:
            at = self.buffer.find(self.fixed, self.follow).translation
        except NoTransformError:
            return camera
        before, self._followed = self._followed or (camera.x_m, camera.y_m, 0.0), at
        return replace(camera, x_m=camera.x_m + at[0] - before[0], y_m=camera.y_m + at[1] - before[1])

    def picture(self, aim: Aim | None, camera: SpaceCamera, columns: int, rows: int) -> CellPicture:
        """Return the picture of what was placed last.

        The names of frames that matter most come first: what the user has chosen, then what has data.
        """
        first = (self.follow, self.fixed, *(one.frame for one in self.layers if one.on))
        shapes = [*self._shapes, *frame_shapes(self._frames, camera.dots_per_m, first)]
        if self.sent is not None and self.sent[0] == self.fixed:
            shapes += self.sent[1].shapes(camera.dots_per_m)
        if aim is not None:
            shapes += aim.shapes(camera.dots_per_m)
        return picture(camera, shapes, columns, rows)

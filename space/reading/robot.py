"""The robot's model: its URDF, of which each link is where the frame of its name is."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from space.drawing.paints import nearest
from space.drawing.shapes import box, cylinder, ellipsoid
from space.reading.fields import Drawable, NotDrawnError, field
from space.robot_model import Cuboid, Cylinder, Sphere
from space.urdf import UrdfError, read_urdf
from text.sentences import reason_of, say

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from space.drawing.shapes import Shape
    from space.robot_model import ModelLink, RobotModel, Visual
    from text.sentences import Words


GREY = (0.7, 0.7, 0.75)
"""Of links without a colour."""


def read_model(text: object) -> RobotModel:
    """Return the robot that a URDF describes. Raises NotDrawnError."""
    if not isinstance(text, str):
        raise NotDrawnError(say("{field} is not a text", field="data"))
    try:
        return read_urdf(text)
    except UrdfError as error:
        raise NotDrawnError(reason_of(error)) from None


class ModelReader:
    """Takes a std_msgs/String with a URDF, and shows boxes, cylinders and spheres."""

    def __init__(self) -> None:
        """Begin without a robot."""
        self._text = ""
        self._links: tuple[Drawable, ...] = ()
        self._meshes = 0
        self._warnings: Sequence[str] = ()

    def read(self, tree: Mapping[str, Any], now_s: float) -> None:
        """Take the description. Raises NotDrawnError."""
        del now_s
        text = field(tree, "data")
        if text == self._text:
            return
        self.clear()
        model = read_model(text)
        self._text, self._warnings = text, model.warnings
        self._links = tuple(map(self._drawable, model.links.values()))

    def shown(self, now_s: float) -> Sequence[Drawable]:
        """Return the links that are seen."""
        del now_s
        return self._links

    @property
    def remark(self) -> Words | None:
        """What is wrong with the description, else how many shapes are in files of their own."""
        if self._warnings:
            return say(
                "faults in the description: {count}; {first}", count=len(self._warnings), first=self._warnings[0]
            )
        if not self._meshes:
            return None
        return say("shapes in files (mesh) are not drawn: {count}", count=self._meshes)

    def clear(self) -> None:
        self._text, self._links, self._meshes, self._warnings = "", (), 0, ()

    def _drawable(self, link: ModelLink) -> Drawable:
        shapes = [shape for visual in link.visuals for shape in self._shapes(visual)]
        return Drawable(link.name, tuple(shapes))

    def _shapes(self, visual: Visual) -> Sequence[Shape]:
        colour = visual.colour
        tint = nearest(*GREY if colour is None else colour[:3])
        shape = visual.shape
        if isinstance(shape, Cuboid):
            return box(visual.origin, shape.size_m, tint)
        if isinstance(shape, Cylinder):
            wide = 2 * shape.radius_m
            return cylinder(visual.origin, (wide, wide, shape.length_m), tint)
        if isinstance(shape, Sphere):
            wide = 2 * shape.radius_m
            return ellipsoid(visual.origin, (wide, wide, wide), tint)
        self._meshes += 1
        return ()

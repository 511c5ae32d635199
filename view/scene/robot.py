"""The robot itself: the shapes of `/robot_description`, each in the frame of its link."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from space.reading.fields import field
from space.reading.robot import read_model
from space.robot_model import Cuboid, Cylinder, Mesh, Sphere
from view.scene.drawn import Drawn, frame_name
from view.scene.solids import Solids

if TYPE_CHECKING:
    from collections.abc import Iterator

    from space.robot_model import Visual
    from view.scene.drawn import Message

ROBOT = "robot"
"""The root of the robot's links in the tree of entities."""
GREY = (0.7, 0.7, 0.7, 1.0)


class RobotShapes:
    """The links of the robot that was described last."""

    def __init__(self) -> None:
        self._text = ""
        self._drawn: list[Drawn] = []

    def read(self, topic: str, message: Message) -> Iterator[Drawn]:
        """Yield the links of a robot, apart from meshes, whose files are not read.

        Raises NotDrawnError if the text describes no robot.
        """
        del topic
        text = field(message, "data")
        if text == self._text:
            return
        model = read_model(text)
        self._text = text
        self._drawn = [
            Drawn((ROBOT, frame_name(name), str(number)), (_shape(visual),), frame_name(name))
            for name, link in model.links.items()
            for number, visual in enumerate(link.visuals)
            if not isinstance(visual.shape, Mesh)
        ]
        # The robot before it may have had other links.
        yield Drawn((ROBOT,), (), recursive=True)
        yield from self._drawn

    def again(self) -> list[Drawn]:
        """Return them again, as a viewer forgets what is old."""
        return self._drawn


def _shape(visual: Visual) -> Any:  # noqa: ANN401
    at, shape = visual.origin, visual.shape
    colour = np.rint(255 * np.array([visual.colour or GREY])).astype(np.uint8)
    solids = partial(Solids, np.array([at.translation]), at.rotation, rgba=colour)
    if isinstance(shape, Cuboid):
        return solids(shape.size_m).boxes()
    assert isinstance(shape, (Cylinder, Sphere))
    wide = 2 * shape.radius_m
    if isinstance(shape, Cylinder):
        return solids((wide, wide, shape.length_m)).cylinders()
    return solids((wide, wide, wide)).ellipsoids()

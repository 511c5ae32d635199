"""The robot itself: the shapes of `/robot_description`, each in the frame of its link."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from space.robot_model import Cuboid, Cylinder, Mesh, Sphere
from space.urdf import UrdfError, read_urdf
from text.sentences import reason_of
from view.scene.drawn import Drawn, UnusableMessageError, frame_name

if TYPE_CHECKING:
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

    def read(self, topic: str, message: Message) -> list[Drawn]:
        """Return the links of a robot, apart from meshes, whose files are not read.

        Raises UnusableMessageError if the text describes no robot.
        """
        del topic
        text = str(message["data"])
        if text == self._text:
            return []
        try:
            model = read_urdf(text)
        except UrdfError as error:
            raise UnusableMessageError(reason_of(error)) from error
        self._text = text
        self._drawn = [
            Drawn((ROBOT, frame_name(name), str(number)), (_shape(visual),), frame_name(name))
            for name, link in model.links.items()
            for number, visual in enumerate(link.visuals)
            if not isinstance(visual.shape, Mesh)
        ]
        # The robot before it may have had other links.
        return [Drawn((ROBOT,), (), recursive=True), *self._drawn]

    def again(self) -> list[Drawn]:
        """Return them again, as a viewer forgets what is old."""
        return self._drawn


def _shape(visual: Visual) -> Any:  # noqa: ANN401
    import rerun

    at, shape = visual.origin, visual.shape
    placed = {
        "centers": [at.translation],
        "quaternions": [at.rotation],
        "colors": tuple(round(255 * share) for share in visual.colour or GREY),
        "fill_mode": "solid",
    }
    if isinstance(shape, Cuboid):
        return rerun.Boxes3D(sizes=[shape.size_m], **placed)
    if isinstance(shape, Cylinder):
        return rerun.Cylinders3D(lengths=[shape.length_m], radii=[shape.radius_m], **placed)
    assert isinstance(shape, Sphere)
    return rerun.Ellipsoids3D(radii=[shape.radius_m], **placed)

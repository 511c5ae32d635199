"""A robot as boxes, cylinders and spheres on links, and the joints that hold the links together.

Names and meanings are those of URDF: http://wiki.ros.org/urdf/XML.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, TypeAlias

from space.transform import Quaternion, Transform, Vector
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

Colour: TypeAlias = tuple[float, float, float, float]
"""Red, green, blue and opacity, 0 to 1."""

AHEAD: Vector = (1.0, 0.0, 0.0)
FARTHEST = 1e12
"""Radians or metres: a wheel turns for ages to get there, and sums are still numbers."""


class JointError(ValueError):
    """Why a joint gives no transform; its text is a sentence for the user."""


@dataclass(frozen=True)
class Cuboid:
    """`<box>`: its middle is the origin."""

    size_m: Vector


@dataclass(frozen=True)
class Cylinder:
    """`<cylinder>`: its axis is z, its middle the origin."""

    radius_m: float
    length_m: float


@dataclass(frozen=True)
class Sphere:
    """`<sphere>`: its middle is the origin."""

    radius_m: float


@dataclass(frozen=True)
class Mesh:
    """`<mesh>`: a shape in a file of its own, which this room does not read."""

    filename: str
    """As written, `package://robot/meshes/head.stl`."""
    scale: Vector = (1.0, 1.0, 1.0)


Solid: TypeAlias = Cuboid | Cylinder | Sphere | Mesh


@dataclass(frozen=True)
class Visual:
    """One shape of a link, as it looks."""

    shape: Solid
    origin: Transform
    """Where the shape is in the link."""
    colour: Colour | None = None
    material: str = ""


@dataclass(frozen=True)
class ModelLink:
    """A rigid part of the robot; its name is that of its frame."""

    name: str
    visuals: tuple[Visual, ...] = ()


class JointType(str, Enum):
    """How a joint moves, as URDF writes it."""

    FIXED = "fixed"
    REVOLUTE = "revolute"
    CONTINUOUS = "continuous"
    PRISMATIC = "prismatic"
    FLOATING = "floating"
    PLANAR = "planar"


TURNING = frozenset({JointType.REVOLUTE, JointType.CONTINUOUS})
LIMITED = frozenset({JointType.REVOLUTE, JointType.PRISMATIC})


@dataclass(frozen=True)
class Mimic:
    """The position follows that of another joint: `multiplier * position + offset`."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class ModelJoint:
    """What holds a link to its parent. Positions are in radians, or in metres if it slides."""

    name: str
    type: JointType
    parent: str
    child: str
    origin: Transform
    """Where the child is in the parent, in position 0."""
    axis: Vector = AHEAD
    """In the child's frame, of length 1."""
    lower: float = -math.inf
    upper: float = math.inf
    velocity: float = math.inf
    """The fastest it can move, rad/s or m/s."""
    mimic: Mimic | None = None

    @property
    def movable(self) -> bool:
        return self.type in TURNING or self.type is JointType.PRISMATIC

    def transform(self, position: float) -> Transform:
        """Return where the child is in the parent, also beyond the limits.

        Raises JointError for what is not a position, and for a joint that one number cannot
        describe.
        """
        if self.type is JointType.FIXED:
            return self.origin
        if not self.movable:
            raise JointError(
                say(
                    "joint {name} is {kind}, and one number does not say where it is: publish its"
                    " transform by a node of your own",
                    name=self.name,
                    kind=self.type.value,
                )
            )
        if not is_position(position):
            raise JointError(say("joint {name} cannot be at {position:g}", name=self.name, position=position))
        if self.type is JointType.PRISMATIC:
            x, y, z = self.axis
            return self.origin @ Transform((x * position, y * position, z * position))
        return self.origin @ Transform(rotation=turned_about(self.axis, position))


@dataclass(frozen=True)
class RobotModel:
    """A tree of links."""

    name: str
    root: str
    """The link that no joint holds."""
    links: Mapping[str, ModelLink]
    joints: Mapping[str, ModelJoint]
    warnings: Sequence[str] = ()
    """What its description has wrong and is left out, sentences with the line."""

    def transform(self, joint: str, position: float = 0.0) -> Transform:
        """Return where a joint's child is in its parent. Raises JointError."""
        found = self.joints.get(joint)
        if found is None:
            raise JointError(say("the robot has no joint {name}", name=joint))
        return found.transform(position)

    def followed(self, positions: Mapping[str, float]) -> dict[str, float]:
        """Return the positions, and those of the joints that follow them (`<mimic>`)."""
        known = dict(positions)
        for joint in self.joints.values():
            way = [joint]
            while (mimic := way[-1].mimic) is not None and way[-1].name not in known:
                way.append(self.joints[mimic.joint])
            position = known.get(way.pop().name)
            for one in reversed(way):
                if one.mimic is not None and position is not None:
                    position = one.mimic.multiplier * position + one.mimic.offset
                    if not is_position(position):
                        break
                    known[one.name] = position
        return known


def is_position(value: float) -> bool:
    """Tell whether a joint can be there: a number that is not beyond all measure."""
    return abs(value) <= FARTHEST


def turned_about(axis: Vector, angle_rad: float) -> Quaternion:
    """Return the rotation about an axis of length 1, by the right-hand rule."""
    x, y, z = axis
    sine = math.sin(angle_rad / 2)
    return x * sine, y * sine, z * sine, math.cos(angle_rad / 2)

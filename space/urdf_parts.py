"""One link and one joint of a URDF, without regard to the others, and what their attributes hold."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from space.robot_model import (
    AHEAD,
    LIMITED,
    Colour,
    Cuboid,
    Cylinder,
    JointType,
    Mesh,
    Mimic,
    ModelJoint,
    ModelLink,
    Solid,
    Sphere,
    Visual,
)
from space.transform import IDENTITY, Transform, Vector
from space.xml_elements import Element, XmlError
from text.i18n import N_
from text.sentences import reason_of, say
from text.suggestions import did_you_mean, no_number

if TYPE_CHECKING:
    from collections.abc import Iterable

FARTHEST_M = 1e5
"""A longer length is a mistake, and sums of far longer ones are not numbers any more."""
LONGEST_SHOWN = 60
"""Characters of a value that a sentence repeats."""
ZEROS: Vector = (0.0, 0.0, 0.0)


def written(element: Element, attribute: str) -> str:
    """Return an attribute that must not be empty. Raises XmlError."""
    value = element.attributes.get(attribute, "").strip()
    if not value:
        raise element.wrong(
            say("<{tag}> has no {attribute}", tag=element.tag, attribute=attribute),
            say('write <{tag} {attribute}="...">', tag=element.tag, attribute=attribute),
        )
    return value


def inner(element: Element, tag: str) -> Element:
    """Return an element that must be there. Raises XmlError."""
    found = element.first(tag)
    if found is None:
        raise element.wrong(say("<{outer}> {name} has no <{tag}>", outer=element.tag, name=name_of(element), tag=tag))
    return found


def name_of(element: Element) -> str:
    """Return the name as it is shown, empty without one."""
    return element.attributes.get("name", "")


def number(element: Element, attribute: str, default: float | None = None) -> float:
    """Return one finite number; without a default it must be there. Raises XmlError."""
    if default is not None and attribute not in element.attributes:
        return default
    (value,) = numbers(element, attribute, 1)
    return value


def numbers(element: Element, attribute: str, count: int) -> tuple[float, ...]:
    """Return so many finite numbers. Raises XmlError."""
    words = written(element, attribute).split()
    if len(words) != count:
        raise element.wrong(
            say(
                "{attribute} of <{tag}> has {found} numbers, and not {count}",
                attribute=attribute,
                tag=element.tag,
                found=len(words),
                count=count,
            ),
            say("separate them with spaces"),
        )
    return tuple(_finite(element, attribute, word) for word in words)


def vector(element: Element, attribute: str, default: Vector) -> Vector:
    """Return three finite numbers, `default` where the attribute is missing. Raises XmlError."""
    if attribute not in element.attributes:
        return default
    x, y, z = numbers(element, attribute, 3)
    return x, y, z


def length(element: Element, attribute: str) -> float:
    """Return a size in metres. Raises XmlError."""
    (metres,) = lengths(element, attribute, 1)
    return metres


def lengths(element: Element, attribute: str, count: int) -> tuple[float, ...]:
    """Return so many sizes in metres. Raises XmlError."""
    sizes = numbers(element, attribute, count)
    for size in sizes:
        if not 0.0 <= size <= FARTHEST_M:
            raise element.wrong(
                say("{attribute} of <{tag}> is {size:g} m", attribute=attribute, tag=element.tag, size=size),
                say("a size is from 0 to {most:g} m", most=FARTHEST_M),
            )
    return sizes


def origin(element: Element) -> Transform:
    """Return the `<origin>` of an element: metres, and roll, pitch and yaw. Raises XmlError."""
    found = element.first("origin")
    if found is None:
        return IDENTITY
    place = vector(found, "xyz", ZEROS)
    if max(map(abs, place)) > FARTHEST_M:
        raise found.wrong(say("<origin> is more than {most:g} m away", most=FARTHEST_M), say("write metres"))
    return Transform.from_rpy(place, vector(found, "rpy", ZEROS))


def one_of(element: Element, attribute: str, known: Iterable[str]) -> str:
    """Return an attribute that must be one of the known words. Raises XmlError."""
    word = written(element, attribute)
    choices = list(known)
    if word not in choices:
        raise element.wrong(
            say(
                "{attribute} of <{tag}> {name} is {word}",
                attribute=attribute,
                tag=element.tag,
                name=name_of(element),
                word=word[:LONGEST_SHOWN],
            ),
            say("it can be: {known}", known=", ".join(choices)),
        )
    return word


def _finite(element: Element, attribute: str, word: str) -> float:
    try:
        # Python would read 1_0 as ten.
        value = float(word.replace("_", "?"))
    except ValueError:
        reason = no_number(word, word[:LONGEST_SHOWN])
    else:
        if math.isfinite(value):
            return value
        reason = say("{word} is not a finite number", word=word[:LONGEST_SHOWN])
    raise element.wrong(say("{attribute} of <{tag}>: {reason}", attribute=attribute, tag=element.tag, reason=reason))


_ONES: Vector = (1.0, 1.0, 1.0)
_WRITE_LIMIT = {
    JointType.REVOLUTE: N_(
        'write <limit lower="-1.57" upper="1.57" effort="1" velocity="1"/>, or make it continuous'
    ),
    JointType.PRISMATIC: N_('write <limit lower="0" upper="0.1" effort="1" velocity="1"/>'),
}
_BYTE = 255.0
"""The most of a colour as other programs write it."""
_SHAPES = ("box", "cylinder", "sphere", "mesh")


class Materials:
    """Colours by name: those of the robot, and those that visuals define in passing.

    urdfdom (`urdf_parser/src/link.cpp`, `model.cpp`) goes on without a colour that is not between 0
    and 1 and without an undefined material, both with a word; a second definition below <robot> it
    refuses, which is said here, and the first counts.
    """

    def __init__(self, robot: Element, warnings: list[str]) -> None:
        """Read the definitions; append what is left out or corrected to `warnings`."""
        self._warnings = warnings
        self._colours: dict[str, Colour | None] = {}
        places = [robot, *(visual for link in robot.all("link") for visual in link.all("visual"))]
        for place in places:
            for element in place.all("material"):
                name = name_of(element)
                if place is robot and name in self._colours:
                    again = element.wrong(
                        say("there is a material {name} already", name=name),
                        say("rename one: RViz refuses two, here the first counts"),
                    )
                    self._warnings.append(reason_of(again))
                elif element.children and name:
                    self._colours.setdefault(name, self._colour(element))

    def of(self, visual: Element) -> tuple[Colour | None, str]:
        """Return the colour of a visual, None without one, and its material.

        A material that is not defined is warned of. Raises XmlError.
        """
        element = visual.first("material")
        if element is None:
            return None, ""
        if element.children:
            return self._colour(element), name_of(element)
        name = written(element, "name")
        if name not in self._colours:
            unknown = element.wrong(
                say("there is no material {name}", name=name),
                did_you_mean(name, self._colours)
                or say('define it below <robot>: <material name="..."><color rgba="1 0 0 1"/>'),
            )
            self._warnings.append(reason_of(unknown))
        return self._colours.get(name), name

    def _colour(self, material: Element) -> Colour | None:
        element = material.first("color")
        if element is None:
            return None
        try:
            red, green, blue, opacity = numbers(element, "rgba", 4)
        except XmlError as error:
            self._warn_once(error)
            return None
        if all(0.0 <= part <= 1.0 for part in (red, green, blue, opacity)):
            return red, green, blue, opacity
        self._warn_once(element.wrong(say("a part of rgba is not between 0 and 1"), say("divide each by 255")))
        if not all(0.0 <= part <= _BYTE for part in (red, green, blue, opacity)):
            return None
        # An opacity of 1 is whole in either way of writing.
        whole = opacity if opacity <= 1.0 else opacity / _BYTE
        return red / _BYTE, green / _BYTE, blue / _BYTE, whole

    def _warn_once(self, error: XmlError) -> None:
        """A material of a visual is read twice: with all definitions, and with its visual."""
        if (words := reason_of(error)) not in self._warnings:
            self._warnings.append(words)


def read_link(element: Element, materials: Materials, warnings: list[str]) -> ModelLink:
    """Return a link with its visuals. Raises XmlError.

    A visual that is wrong is left out with a word, as urdfdom (`urdf_parser/src/model.cpp`) does:
    the link and its frame are there without it.
    """
    name = written(element, "name")
    visuals = []
    for visual in element.all("visual"):
        try:
            visuals.append(_visual(visual, materials))
        except XmlError as error:  # noqa: PERF203 - a wrong one does not cost the others
            reason = reason_of(error)
            warnings.append(say("{reason} (this <visual> is left out)", reason=reason))
    return ModelLink(name, tuple(visuals))


def read_joint(element: Element, warnings: list[str]) -> ModelJoint:
    """Return a joint; what urdfdom does not check is added to the warnings. Raises XmlError."""
    name = written(element, "name")
    kind = JointType(one_of(element, "type", [each.value for each in JointType]))
    lower, upper, velocity = _limits(element, kind, warnings)
    return ModelJoint(
        name,
        kind,
        written(inner(element, "parent"), "link"),
        written(inner(element, "child"), "link"),
        origin(element),
        _axis(element, kind, warnings),
        lower,
        upper,
        velocity,
        _mimic(element),
    )


def _visual(element: Element, materials: Materials) -> Visual:
    geometry = inner(element, "geometry")
    shape = next((child for child in geometry.children if child.tag in _SHAPES), None)
    if shape is None:
        raise geometry.wrong(say("<geometry> has no shape"), say("it can be: {known}", known=", ".join(_SHAPES)))
    return Visual(_solid(shape), origin(element), *materials.of(element))


def _solid(shape: Element) -> Solid:
    if shape.tag == "box":
        x, y, z = lengths(shape, "size", 3)
        return Cuboid((x, y, z))
    if shape.tag == "cylinder":
        return Cylinder(length(shape, "radius"), length(shape, "length"))
    if shape.tag == "sphere":
        return Sphere(length(shape, "radius"))
    return Mesh(written(shape, "filename"), vector(shape, "scale", _ONES))


def _axis(element: Element, kind: JointType, warnings: list[str]) -> Vector:
    """Return the axis, x for one without a length, which urdfdom takes as it is."""
    found = element.first("axis")
    if found is None or kind in (JointType.FIXED, JointType.FLOATING):
        return AHEAD
    x, y, z = vector(found, "xyz", AHEAD)
    size = math.hypot(x, y, z)
    if not 0.0 < size < math.inf or not math.isclose(math.hypot(x / size, y / size, z / size), 1.0):
        wrong = found.wrong(
            say("the axis of joint {name} has no length", name=name_of(element)),
            say('write one such as <axis xyz="0 0 1"/>'),
        )
        warnings.append(reason_of(wrong))
        return AHEAD
    return x / size, y / size, z / size


def _limits(element: Element, kind: JointType, warnings: list[str]) -> tuple[float, float, float]:
    """Return the lowest and highest position, and the highest speed.

    Whether the lower limit is the lower one, urdfdom (`urdf_parser/src/joint.cpp`) does not look.
    """
    found = element.first("limit")
    if found is None:
        if kind not in LIMITED:
            return -math.inf, math.inf, math.inf
        raise element.wrong(
            say("joint {name} is {kind} without a <limit>", name=name_of(element), kind=kind.value),
            say(_WRITE_LIMIT[kind]),
        )
    # RViz and ROS's own publisher refuse a limit without both.
    velocity, _effort = number(found, "velocity"), number(found, "effort")
    lower, upper = number(found, "lower", 0.0), number(found, "upper", 0.0)
    if kind not in LIMITED:
        return -math.inf, math.inf, velocity
    if lower > upper:
        wrong = found.wrong(
            say("the lower limit of joint {name} is above the upper one", name=name_of(element)), say("swap them")
        )
        warnings.append(reason_of(wrong))
    return min(lower, upper), max(lower, upper), velocity


def _mimic(element: Element) -> Mimic | None:
    found = element.first("mimic")
    if found is None:
        return None
    return Mimic(written(found, "joint"), number(found, "multiplier", 1.0), number(found, "offset", 0.0))

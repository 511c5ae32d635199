"""Reading URDF, the text that describes a robot: http://wiki.ros.org/urdf/XML.

What is seen and what moves is read: links with their visuals, and joints. Masses, collisions,
transmissions and what is meant for simulators are passed over, as are elements that URDF does not
know. What RViz refuses is refused here as well, but with the line and with what to do; what it only
warns of, or does not look at, is a warning of the model.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

from space.robot_model import ModelJoint, ModelLink, RobotModel
from space.urdf_parts import Materials, name_of, read_joint, read_link, written
from space.xml_elements import Element, XmlError, decoded, read_elements
from text.sentences import reason_of, say
from text.suggestions import did_you_mean

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

XACRO = "xacro:"
_SHOWN = 3
"""Names that a sentence lists."""

T = TypeVar("T")


class UrdfError(ValueError):
    """Why a text describes no robot; its text is a sentence with the line and the fix."""


def read_urdf(text: str) -> RobotModel:
    """Return the robot that a text describes. Raises UrdfError."""
    try:
        return _robot(read_elements(text))
    except XmlError as error:
        raise UrdfError(reason_of(error)) from None


def urdf_of(raw: bytes) -> str:
    """Return the text of a URDF file, in whichever encoding it declares. Raises UrdfError."""
    try:
        return decoded(raw)
    except XmlError as error:
        raise UrdfError(reason_of(error)) from None


def _robot(robot: Element) -> RobotModel:
    _refuse_xacro(robot)
    if robot.tag != "robot":
        raise robot.wrong(say("the outermost element is <{tag}>", tag=robot.tag), say("URDF begins with <robot>"))
    warnings: list[str] = []
    materials = Materials(robot, warnings)
    links = _by_name(robot.all("link"), lambda element: read_link(element, materials, warnings))
    joints = _by_name(robot.all("joint"), lambda element: read_joint(element, warnings))
    if not links:
        raise robot.wrong(say("<robot> has no <link>"), say("a robot has at least one"))
    elements = {name_of(element).strip(): element for element in robot.all("joint")}
    _check_ends(joints, elements, links)
    joints, unfollowed = _without_vain_mimics(joints, elements)
    root = _root(robot, joints, elements, links)
    return RobotModel(name_of(robot), root, links, joints, (*warnings, *unfollowed))


def _refuse_xacro(robot: Element) -> None:
    waiting = [robot]
    while waiting:
        element = waiting.pop()
        if element.tag.startswith(XACRO) or any("${" in value for value in element.attributes.values()):
            raise element.wrong(
                say("this is xacro, from which URDF is still to be made"),
                say("run xacro first: xacro robot.urdf.xacro > robot.urdf"),
            )
        waiting.extend(reversed(element.children))


def _by_name(elements: Iterable[Element], read: Callable[[Element], T]) -> dict[str, T]:
    found: dict[str, T] = {}
    lines: dict[str, int] = {}
    for element in elements:
        name = written(element, "name")
        if name in found:
            raise element.wrong(
                say(
                    "<{tag}> {name} is there a second time, first in line {first}",
                    tag=element.tag,
                    name=name,
                    first=lines[name],
                ),
                say("rename one"),
            )
        found[name], lines[name] = read(element), element.line
    return found


def _check_ends(
    joints: Mapping[str, ModelJoint], elements: Mapping[str, Element], links: Mapping[str, ModelLink]
) -> None:
    """Refuse a joint to an unknown link, and a second joint that holds the same link."""
    held_by: dict[str, str] = {}
    for name, joint in joints.items():
        element = elements[name]
        for end in (joint.parent, joint.child):
            if end not in links:
                raise element.wrong(
                    say("joint {name}: there is no link {link}", name=name, link=end),
                    did_you_mean(end, links) or say('write <link name="..."/>'),
                )
        other = held_by.setdefault(joint.child, name)
        if other != name:
            raise element.wrong(
                say("link {link} is held by two joints, {one} and {other}", link=joint.child, one=other, other=name),
                say("remove one: a robot is a tree"),
            )


def _without_vain_mimics(
    joints: Mapping[str, ModelJoint], elements: Mapping[str, Element]
) -> tuple[dict[str, ModelJoint], list[str]]:
    """Return the joints, each of which follows another in the end or nobody, and remarks."""
    found, told = dict(joints), []
    ends_well: set[str] = set()
    for name in joints:
        way: dict[str, None] = {}
        here = name
        while here not in ends_well and (mimic := found[here].mimic) is not None:
            way[here] = None
            if mimic.joint not in joints:
                wrong = elements[here].wrong(
                    say("joint {name}: there is no joint {other}", name=here, other=mimic.joint),
                    did_you_mean(mimic.joint, joints) or say("correct <mimic>"),
                )
            elif mimic.joint in way:
                wrong = elements[here].wrong(
                    say("joint {name} follows itself by <mimic>", name=here), say("one of the joints must not follow")
                )
            else:
                here = mimic.joint
                continue
            told.append(reason_of(wrong))
            found[here] = replace(found[here], mimic=None)
        ends_well.update(way)
    return found, told


def _root(
    robot: Element, joints: Mapping[str, ModelJoint], elements: Mapping[str, Element], links: Mapping[str, ModelLink]
) -> str:
    """Return the only link that no joint holds, from which all others can be reached."""
    holds: dict[str, list[str]] = {}
    for joint in joints.values():
        holds.setdefault(joint.parent, []).append(joint.child)
    held = {joint.child for joint in joints.values()}
    roots = [link for link in links if link not in held]
    if len(roots) > 1:
        second = next(link for link in robot.all("link") if written(link, "name") == roots[1])
        raise second.wrong(
            say("{count} links are held by no joint: {links}", count=len(roots), links=_few(roots)),
            say("join all but one to the rest by a joint"),
        )
    reached, waiting = set(roots), list(roots)
    while waiting:
        below = holds.get(waiting.pop(), ())
        reached.update(below)
        waiting.extend(below)
    for name, joint in joints.items():
        if joint.child not in reached:
            raise elements[name].wrong(
                say("link {link} is held by joints in a loop", link=joint.child),
                say("remove one of them: a robot is a tree"),
            )
    return roots[0]


def _few(names: list[str]) -> str:
    more = ["..."] if len(names) > _SHOWN else []
    return ", ".join(names[:_SHOWN] + more)

"""Reading URDF: what it says, and what is said of what is none."""

from __future__ import annotations

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from space.robot_model import Cuboid, Cylinder, JointType, Mesh, Mimic, Sphere
from space.transform import Transform
from space.urdf import UrdfError, read_urdf

ARM = """<?xml version="1.0"?>
<robot name="arm">
  <material name="blue"><color rgba="0 0 0.8 1"/></material>
  <link name="base">
    <visual>
      <origin xyz="0 0 0.1" rpy="0 0 1.5707963267948966"/>
      <geometry><box size="0.3 0.2 0.1"/></geometry>
      <material name="blue"/>
    </visual>
    <visual>
      <geometry><mesh filename="package://arm/base.stl" scale="1 1 -1"/></geometry>
      <material name="red"><color rgba="1 0 0 0.5"/></material>
    </visual>
    <collision><geometry><box size="1 1 1"/></geometry></collision>
  </link>
  <link name="upper">
    <visual><geometry><cylinder radius="0.05" length="0.4"/></geometry></visual>
  </link>
  <link name="hand">
    <visual><geometry><sphere radius="0.06"/></geometry><material name="red"/></visual>
  </link>
  <link name="finger"/>
  <joint name="shoulder" type="revolute">
    <parent link="base"/> <child link="upper"/>
    <origin xyz="0.5 0 0.2"/> <axis xyz="0 0 2"/>
    <limit lower="-1" upper="2" effort="3" velocity="4"/>
  </joint>
  <joint name="wrist" type="continuous"><parent link="upper"/><child link="hand"/></joint>
  <joint name="grip" type="prismatic">
    <parent link="hand"/> <child link="finger"/>
    <origin rpy="0 0 1.5707963267948966"/> <axis xyz="0 1 0"/>
    <limit upper="0.1" effort="1" velocity="1"/>
    <mimic joint="wrist" multiplier="0.5" offset="0.01"/>
  </joint>
  <gazebo reference="base"><anything/></gazebo>
</robot>
"""


def robot(*parts: str) -> str:
    """A robot of the links a and b, and what follows in line 2 and below."""
    return "\n".join(("<robot name='r'><link name='a'/><link name='b'/>", *parts, "</robot>"))


def joint(inside: str = "", kind: str = "fixed", ends: tuple[str, str] = ("a", "b")) -> str:
    parent, child = ends
    return f"<joint name='j' type='{kind}'><parent link='{parent}'/><child link='{child}'/>{inside}</joint>"


def visual(shape: str, material: str = "") -> str:
    return robot(f"<link name='c'><visual><geometry>{shape}</geometry>{material}</visual></link>", joint())


def refusal(text: str) -> str:
    """What is said of a text, empty if it is read."""
    try:
        read_urdf(text)
    except UrdfError as error:
        return str(error)
    return ""


def test_links_are_shapes_at_places_in_colours() -> None:
    arm = read_urdf(ARM)
    assert (arm.name, arm.root) == ("arm", "base")
    assert list(arm.links) == ["base", "upper", "hand", "finger"]
    box, mesh = arm.links["base"].visuals
    assert (box.shape, box.colour, box.material) == (Cuboid((0.3, 0.2, 0.1)), (0.0, 0.0, 0.8, 1.0), "blue")
    assert box.origin.point((1.0, 0.0, 0.0)) == pytest.approx((0.0, 1.0, 0.1))
    assert mesh.shape == Mesh("package://arm/base.stl", (1.0, 1.0, -1.0))
    (cylinder,) = arm.links["upper"].visuals
    assert (cylinder.shape, cylinder.colour) == (Cylinder(0.05, 0.4), None)
    (ball,) = arm.links["hand"].visuals
    # Defined by another link's visual, as RViz accepts it.
    assert (ball.shape, ball.colour) == (Sphere(0.06), (1.0, 0.0, 0.0, 0.5))
    assert arm.links["finger"].visuals == ()


def test_joints_have_ends_axes_and_limits() -> None:
    joints = read_urdf(ARM).joints
    shoulder = joints["shoulder"]
    assert (shoulder.type, shoulder.parent, shoulder.child) == (JointType.REVOLUTE, "base", "upper")
    assert (shoulder.axis, shoulder.lower, shoulder.upper, shoulder.velocity) == ((0.0, 0.0, 1.0), -1.0, 2.0, 4.0)
    assert (joints["wrist"].axis, joints["wrist"].upper) == ((1.0, 0.0, 0.0), math.inf)
    assert joints["grip"].mimic == Mimic("wrist", 0.5, 0.01)


def test_joints_turn_by_the_right_hand_rule_and_slide_along_their_own_axis() -> None:
    arm = read_urdf(ARM)
    turned = arm.transform("shoulder", math.pi / 2)
    assert turned.point((1.0, 0.0, 0.0)) == pytest.approx((0.5, 1.0, 0.2))
    assert arm.transform("wrist", math.pi / 2).point((0.0, 1.0, 0.0)) == pytest.approx((0, 0, 1))
    # The axis y of a frame that is turned to the left points backwards.
    assert arm.transform("grip", 0.1).translation == pytest.approx((-0.1, 0.0, 0.0))
    assert arm.transform("shoulder") == Transform((0.5, 0.0, 0.2))


HOSTILE = {
    "nothing": ("", "line 1: the text ends before"),
    "no XML": ("wheels: 4", "line 1: this is not XML"),
    "an unclosed tag": ("<robot>\n<link name='a'>\n</robot>", "line 3: this tag closes another"),
    "two ends": ("<robot/>\n<robot/>", "line 2: something follows the end"),
    "another format": ("<sdf/>", "outermost element is <sdf>; URDF begins with <robot>"),
    "xacro": ("<robot>\n<xacro:include filename='x'/></robot>", "line 2: .* run xacro first"),
    "an expression": ("<robot>\n<link name='${side}'/></robot>", "line 2: .* run xacro first"),
    "a bomb": ('<!DOCTYPE r [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;">]>\n<robot name="&b;"/>',
     "line 1: a document type .* remove it"),
    "a file's text": ('\n<!DOCTYPE r [<!ENTITY a SYSTEM "/etc/passwd">]>\n<robot name="&a;"/>',
     "line 2: a document type"),
    "an entity": ("<robot name='&auml;'/>", "line 1: only &lt;"),
    "an escape": ("<robot>\n\x1b[2J</robot>", "line 2: a '<', a quote or a character"),
    "half a character": ("<robot>\n\ud800</robot>", r"line 2: the character U\+D800"),
    "ten megabytes": (f"<robot>{' ' * 10_000_000}</robot>", "longer than 4 MiB"),
    "a deep well": ("<a>" * 100_000, "more than 100 elements"),
    "no links": ("<robot/>", "<robot> has no <link>"),
    "two roots": (robot(), "line 1: 2 links are held by no joint: a, b; join all but one"),
    "no name": ("<robot>\n<link/></robot>", 'line 2: <link> has no name; write <link name="...">'),
    "a name twice": (robot("<link name='a'/>"), "line 2: <link> a .*, first in line 1; rename one"),
    "a joint twice": (robot("<link name='c'/>", joint(), joint(ends=("a", "c"))),
     "line 4: <joint> j .*, first in line 3"),
    "a link held twice": (robot(joint(), joint().replace("'j'", "'k'")),
     "line 3: link b is held by two joints, j and k; remove one"),
    "no root": (robot(joint(), joint(ends=("b", "a")).replace("'j'", "'k'")),
     "line 2: link b is held by joints in a loop"),
    "a loop beside a root": (
        robot(
            "<link name='c'/>",
            joint(ends=("c", "b")),
            joint(ends=("b", "c")).replace("'j'", "'k'"),
        ),
        "line 3: link b is held by joints in a loop",
    ),
    "its own parent": (robot(joint(ends=("b", "b"))), "line 2: link b is held by joints in a loop"),
    "an unknown link": (robot(joint(ends=("a", "wheel"))), "line 2: .* there is no link wheel; wr"),
    "a mistyped link": (robot("<link name='camera_link'/>", joint(ends=("a", "camera_lnk"))),
     "line 3: .* no link camera_lnk; did you mean camera_link?"),
    "no child": (robot("<joint name='j' type='fixed'><parent link='a'/></joint>"), "no <child>"),
    "an unknown kind": (robot(joint(kind="hinge")),
     "type of <joint> j is hinge; it can be: fixed,"),
    "a place far away": (robot(joint("<origin xyz='1e9 0 0'/>")), "more than"),
    "a hinge without limits": (robot(joint(kind="revolute")), "without a <limit>; write <limit lo"),
    "a slide without limits": (robot(joint(kind="prismatic")),
     "without a <limit>; write <limit lo"),
    "a limit without a speed": (robot(joint("<limit lower='0' upper='1' effort='1'/>", "revolute")),
     "<limit> has no velocity"),
    "a limit that is no number, of a joint without limits": (
     robot(joint("<limit lower='-inf' effort='1' velocity='1'/>", "continuous")),
     "lower of <limit>: -inf is not a finite number"),
    "a number as Python writes it": (
     robot(joint("<limit upper='1_0' effort='1' velocity='1'/>", "revolute")),
     "upper of <limit>: expected a number, got 1_0"),
}  # fmt: skip


@pytest.mark.parametrize("case", HOSTILE)
def test_what_is_no_robot_is_told_by_line_and_mend(case: str) -> None:
    text, said = HOSTILE[case]
    told = refusal(text)
    assert re.search(said, told), told


def coloured(material: str, above: str = "") -> str:
    """A robot of one link, whose only visual has this material."""
    return (
        f"<robot>{above}<link name='a'><visual><geometry><sphere radius='1'/></geometry>"
        f"{material}</visual></link></robot>"
    )


WARNED = {
    "a colour to 255": (coloured("<material name='x'><color rgba='255 0 0 1'/></material>"),
     "a part of rgba is not between 0 and 1; divide each by 255"),
    "a material twice": (
        robot("<material name='m'><color rgba='1 0 0 1'/></material>" * 2, joint()),
        "there is a material m already; rename one: RViz refuses two, here the first counts",
    ),
    "swapped limits": (
        robot(joint("<limit lower='1' upper='0' effort='1' velocity='1'/>", "revolute")),
        "the lower limit of joint j is above the upper one; swap them",
    ),
    "an axis of no length": (robot(joint("<axis xyz='0 0 0'/>", "continuous")),
     "the axis of joint j has no length; write one such as"),
    "a colour of three parts": (coloured("<material name='x'><color rgba='1 0 0'/></material>"),
     "rgba of <color> has 3 numbers, and not 4"),
    "an unknown material": (coloured("<material name='x'/>"),
     "there is no material x; define it below <robot>: "),
    "a joint that follows itself": (robot(joint("<mimic joint='j'/>", "continuous")),
     "joint j follows itself by <mimic>; one of the joints must not follow"),
    "a joint that follows nobody": (robot(joint("<mimic joint='elbow'/>", "continuous")),
     "joint j: there is no joint elbow; correct <mimic>"),
}  # fmt: skip


LEFT_OUT = [
    (visual("<box size='1 nan 1'/>"), "size of <box>: nan is not a fin"),
    (visual("<sphere radius='0,5'/>"), "write a fraction with a point: 0.5"),
    (visual("<sphere radius='-1'/>"), "radius of <sphere> is -1 m"),
    (visual("<box size='1 2'/>"), "size of <box> has 2 numbers, and not 3"),
    (visual("<cylinder radius='1' length='1e300'/>"), r"is 1e\+300 m"),
    (visual("<cone/>"), "<geometry> has no shape; it can be: box,"),
    (visual("<mesh/>"), "<mesh> has no filename"),
    (robot("<link name='c'><visual/></link>", joint()), "<visual> .*has no <geometry>"),
]


@pytest.mark.parametrize(("text", "said"), LEFT_OUT)
def test_a_visual_that_is_wrong_is_left_out_with_a_word_and_its_link_is_there(text: str, said: str) -> None:
    ball = "<visual><geometry><sphere radius='1'/></geometry></visual>"
    second = "<joint name='k' type='fixed'><parent link='b'/><child link='c'/></joint>"
    model = read_urdf(text.replace("</link>", f"{ball}</link>").replace("</robot>", f"{second}</robot>"))
    assert [visual.shape for visual in model.links["c"].visuals] == [Sphere(1.0)]
    (warning,) = model.warnings
    assert re.search(rf"line 2: .*{said}.* \(this <visual> is left out\)$", warning), warning


@pytest.mark.parametrize("kind", ["fixed", "floating"])
def test_the_axis_of_a_joint_that_has_none_is_not_looked_at(kind: str) -> None:
    assert read_urdf(robot(joint("<axis xyz='0 x'/>", kind))).warnings == ()


@pytest.mark.parametrize("case", WARNED)
def test_what_urdfdom_warns_of_or_does_not_check_is_warned_of_and_left_out(case: str) -> None:
    text, said = WARNED[case]
    model = read_urdf(text)
    (warning,) = model.warnings
    assert re.match(r"line \d+: ", warning)
    assert said in warning
    assert all(joint.mimic is None for joint in model.joints.values())
    assert model.followed({}) == {}


@given(st.lists(st.sampled_from([*"<>/='\"&; \n", "robot", "link", "joint", "name", "a", "1"])))
def test_any_text_is_read_or_refused_in_a_sentence(words: list[str]) -> None:
    told = refusal("<robot><link name='a'/>" + "".join(words) + "</robot>")
    assert not told or told.startswith("line ")

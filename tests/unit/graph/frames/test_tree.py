"""The tree of frames, and what is wrong with it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

import pytest

from graph.data import FrameRow, GraphUpdate, TopicRow
from graph.findings.finding import GraphFinding
from graph.frames.findings import findings_in
from graph.frames.tree import FrameTree
from space.buffer import Stamped
from space.transform import IDENTITY
from text.i18n import localized


def tree(*edges: str) -> FrameTree:
    """Of `parent/child`, each heard on /tf; `parent:child` is heard on /tf_static."""
    rows = []
    for edge in edges:
        parent, child = edge.replace(":", "/").split("/")
        rows.append(FrameRow(Stamped(parent, child, 0.0, IDENTITY, ":" in edge), 1))
    return FrameTree(rows)


def drawn(of: FrameTree) -> list[str]:
    return [f"{line.branch}{line.frame}{' *' if line.again else ''}" for line in of.lines()]


def test_a_robot_is_drawn_from_its_root_down() -> None:
    robot = tree("odom/base_link", "base_link:head", "head:eye", "base_link:sonar", "map/odom")
    assert drawn(robot) == ["map", "└ odom", "  └ base_link", "    ├ head", "    │ └ eye", "    └ sonar"]
    assert robot.roots == ("map",)
    assert robot.root_of("eye") == robot.root_of("map") == "map"
    assert not robot.loops


def test_a_frame_with_two_parents_is_drawn_below_both_and_its_children_once() -> None:
    both = tree("odom/base", "world/base", "base/head")
    assert drawn(both) == ["odom", "└ base", "  └ head", "world", "└ base *"]
    assert both.parents["base"] == ("odom", "world")
    assert both.parts == ("odom",)
    assert tree("odom/base", "world/base", "arm/gripper", "x/y", "y/x").parts == ("arm", "odom", "x")


def test_loops_are_found_and_drawn_to_where_they_close() -> None:
    ring = tree("a/b", "b/c", "c/a", "b/lamp")
    assert ring.loops == (("a", "b", "c"),)
    assert drawn(ring) == ["a", "└ b", "  ├ c", "  │ └ a *", "  └ lamp"]
    assert tree("a/b", "b/a", "root/x").roots == ("a", "root")


NOW_S = 1.75e9


def heard(parent: str, child: str, *, static: bool = False, **changes: Any) -> FrameRow:
    """A frame with which nothing is wrong, but for the changes."""
    stamp_s = changes.pop("stamp_s", NOW_S)
    publishers = changes.pop("publishers", ("/static",) if static else ("/driver",))
    newest = Stamped(parent, child, stamp_s, IDENTITY, static)
    row = FrameRow(newest, 100, None if static else 50.0, 0.1, 0.01, publishers)
    return replace(row, **changes)


ROBOT = (
    heard("odom", "base_link"),
    heard("base_link", "camera_link", static=True),
    heard("base_link", "wheel_left"),
    heard("base_link", "wheel_right"),
)


def find(*rows: FrameRow, named: Mapping[str, str] = MappingProxyType({})) -> list[GraphFinding]:
    """What is wrong with frames; `named`: topic to the frame that its header names."""
    topics = tuple(
        TopicRow(topic, ("sensor_msgs/msg/Image",), 1, 0, frame_id=frame) for topic, frame in named.items()
    )
    return findings_in(GraphUpdate(0.0, topics, frames=rows), FrameTree(rows))


def only(*rows: FrameRow, named: Mapping[str, str] = MappingProxyType({})) -> GraphFinding:
    (found,) = find(*rows, named=named)
    # Both are sentences in either language, whatever is put into them.
    assert localized(found.what, "ru") != found.what
    assert localized(found.mend, "ru") != found.mend
    return found


def test_nothing_is_wrong_with_a_robot_as_it_should_be() -> None:
    named = {"/image": "camera_link", "/scan": "/base_link", "/map": ""}
    assert find(*ROBOT, named=named) == []
    assert find() == find(named={"/image": "camera_link"}) == []


HEAD = heard("base_link", "head")
SILENT = replace(HEAD, age_s=4.0)
BY_TURNS = replace(HEAD, contested=True, publishers=("/ekf", "/wheels"))
STATIC = heard("base_link", "head", static=True)
LENS = heard("camera_lnk", "lens", publishers=("/camera",))
NAMED = {"/camera/image": "camera_lnk", "/camera/info": "camera_lnk"}


@pytest.mark.parametrize(
    ("rows", "rule", "frames", "said"),
    [
        ([SILENT], "stale", "head", ["head: silent for 4 s", "/driver"]),
        ([replace(SILENT, publishers=())], "stale", "head",
         ["the node that published it has gone"]),
        ([replace(SILENT, publishers=(), gone="/neck")], "stale", "head",
         ["/neck, which published it, has gone: start it again"]),
        ([heard("map", "odom"), heard("map", "base_link", publishers=("/slam",))], "two parents",
         "base_link map odom", ["base_link has two parents: map by /slam, odom by /driver"]),
        ([heard("arm_base", "gripper")], "two roots", "odom arm_base",
         ["--frame-id odom --child-frame-id arm_base"]),
        ([LENS], "two roots", "odom camera_lnk", ["is camera_lnk a slip for camera_link?", "/camera"]),
        (NAMED, "unknown frame", "camera_lnk",
         ["/camera/image, /camera/info: the header names camera_lnk", "camera_link"]),
        ({"/scan": "lidar"}, "unknown frame", "lidar", ["--frame-id odom --child-frame-id lidar"]),
        ([replace(HEAD, delay_s=-0.5)], "clock", "head", ["0.5 s in the future"]),
        ([replace(HEAD, delay_s=2.0)], "clock", "head", ["2.0 s before it arrives"]),
        ([heard("base_link", "head", delay_s=NOW_S, stamp_s=0.0)], "clock", "head",
         ["0.0 s, which cannot be the present time"]),
        ([replace(STATIC, moved=True)], "static moved", "head",
         ["head: comes on /tf_static with different numbers"]),
        ([BY_TURNS], "contested", "head",
         ["/ekf, /wheels publish head by turns, so that it jumps"]),
        ([replace(BY_TURNS, certain=False)], "contested", "head",
         ["several publishers send head by turns", "/ekf, /wheels"]),
        ([replace(BY_TURNS, publishers=("/ekf", "/ekf"))], "contested", "head",
         ["/ekf (2 of this name) publish head by turns"]),
        ([replace(HEAD, fault="its quaternion is all zeros", faults=7)], "numbers", "head",
         ["head: its quaternion is all zeros; refused 7 of 100"]),
    ],
)  # fmt: skip
def test_what_is_wrong_with_frames_is_told_with_what_to_do(
    rows: list[FrameRow] | dict[str, str], rule: str, frames: str, said: list[str]
) -> None:
    found = only(*ROBOT, named=rows) if isinstance(rows, dict) else only(*ROBOT, *rows)
    assert found.rule == rule
    assert set(found.nodes) == set(frames.split())
    assert all(words in f"{found.what}\n{found.mend}" for words in said)


@pytest.mark.parametrize(("certain", "said"), [(False, "one of /x, /y"), (True, "/x, /y")])
def test_a_loop_is_told_with_the_publisher_that_closes_it(certain: bool, said: str) -> None:
    closing = heard("c", "a", publishers=("/x", "/y"), certain=certain)
    (loop,) = find(heard("a", "b"), heard("b", "c"), closing)
    assert loop.rule == "loop"
    assert loop.what.startswith("a → b → c and back to a")
    assert f"c → a out of {said}" in loop.mend


@pytest.mark.parametrize(
    "row",
    [
        replace(SILENT, hz=0.5),
        replace(HEAD, age_s=0.9, hz=100.0),
        # A static frame holds whenever it was stamped.
        replace(STATIC, delay_s=-0.5),
        heard("base_link", "head", static=True, delay_s=NOW_S, stamp_s=0.0),
    ],
)
def test_what_may_be_as_it_is_is_not_told(row: FrameRow) -> None:
    assert find(*ROBOT, row) == []

"""The tree that frames make: its drawing, its roots and its loops."""

from __future__ import annotations

import pytest

from graph.data import FrameRow
from space.buffer import Stamped
from space.transform import IDENTITY
from space.tree.tree import FrameTree


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
    assert drawn(robot) == [
        "map",
        "└ odom",
        "  └ base_link",
        "    ├ head",
        "    │ └ eye",
        "    └ sonar",
    ]
    assert robot.roots == ("map",)
    assert robot.root_of("eye") == robot.root_of("map") == "map"
    assert not robot.loops


def test_the_largest_tree_comes_first() -> None:
    assert drawn(tree("a/b", "map/odom", "odom/base")) == ["map", "└ odom", "  └ base", "a", "└ b"]


def test_a_frame_with_two_parents_is_drawn_below_both_and_its_children_once() -> None:
    both = tree("odom/base", "world/base", "base/head")
    assert drawn(both) == ["odom", "└ base", "  └ head", "world", "└ base *"]
    assert both.parents["base"] == ("odom", "world")
    assert both.parts == ("odom",)
    assert tree("odom/base", "world/base", "arm/gripper", "x/y", "y/x").parts == (
        "arm",
        "odom",
        "x",
    )


def test_one_that_comes_on_both_topics_is_one_line() -> None:
    (root, line) = tree("odom/base", "odom:base").lines()
    assert root.heard == ()
    assert [one.is_static for one in line.heard] == [False, True]


def test_loops_are_found_and_drawn_to_where_they_close() -> None:
    ring = tree("a/b", "b/c", "c/a", "b/lamp")
    assert ring.loops == (("a", "b", "c"),)
    assert drawn(ring) == ["a", "└ b", "  ├ c", "  │ └ a *", "  └ lamp"]
    assert tree("a/b", "b/a", "root/x").roots == ("a", "root")


def test_a_loop_that_hangs_on_a_root_is_found_too() -> None:
    caught = tree("root/a", "a/b", "b/a")
    assert caught.loops == (("a", "b"),)
    assert caught.roots == ("root",)
    assert drawn(caught) == ["root", "└ a", "  └ b", "    └ a *"]


@pytest.mark.parametrize("closed", [False, True])
def test_an_arm_of_two_thousand_joints_is_drawn(closed: bool) -> None:
    edges = [f"joint_{number}/joint_{number + 1}" for number in range(2000)]
    if closed:
        edges.append("joint_2000/joint_0")
    arm = tree(*edges)
    assert len(arm.lines()) == 2001 + closed
    assert len(arm.loops) == closed


def test_names_that_are_none_make_no_tree() -> None:
    rows = [FrameRow(Stamped("a", name, 0.0, IDENTITY), 1) for name in ("", "a")]
    assert FrameTree(rows).lines() == []


def test_some_frames_are_drawn_with_all_that_is_above_them() -> None:
    robot = tree("odom/base", "base:head", "head:eye", "base:sonar", "map/base", "x/y", "y/x")
    only = robot.with_ancestors(["eye"])
    assert only == {"eye", "head", "base", "odom", "map"}
    shown = [f"{line.branch}{line.frame}" for line in robot.lines(only)]
    assert shown == ["map", "└ base", "  └ head", "    └ eye", "odom", "└ base"]
    assert robot.with_ancestors(["y", "nowhere"]) == {"x", "y", "nowhere"}
    assert robot.lines(()) == []

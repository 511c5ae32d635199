"""The tree of frames, and what is wrong with it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from graph.data import FrameRow
from graph.frames.findings import FrameFinding, FrameTrouble, Surroundings, frame_findings
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


def find(*rows: FrameRow, **around: Any) -> list[FrameFinding]:
    return frame_findings(FrameTree(rows), rows, Surroundings(**around))


def only(*rows: FrameRow, **around: Any) -> FrameFinding:
    (found,) = find(*rows, **around)
    # Both are sentences in either language, whatever is put into them.
    assert localized(found.text, "ru") != found.text
    assert localized(found.advice, "ru") != found.advice
    return found


def test_nothing_is_wrong_with_a_robot_as_it_should_be() -> None:
    named = {"/image": "camera_link", "/scan": "/base_link", "/map": ""}
    assert find(*ROBOT, named=named, most=2000) == []
    assert find() == find(named={"/image": "camera_link"}) == []


HEAD = heard("base_link", "head")
SILENT = replace(HEAD, age_s=4.0)
BY_TURNS = replace(HEAD, contested=True, publishers=("/ekf", "/wheels"))
STATIC = heard("base_link", "head", static=True)
LENS = heard("camera_lnk", "lens", publishers=("/camera",))
NAMED = {"/camera/image": "camera_lnk", "/camera/info": "camera_lnk"}


@pytest.mark.parametrize(
    ("rows", "trouble", "frames", "said"),
    [
        ([SILENT], "STALE", "head", ["head: silent for 4 s", "/driver"]),
        ([replace(SILENT, publishers=())], "STALE", "head",
         ["the node that published it has gone"]),
        ([replace(SILENT, publishers=(), gone="/neck")], "STALE", "head",
         ["/neck, which published it, has gone: start it again"]),
        ([heard("map", "odom"), heard("map", "base_link", publishers=("/slam",))], "PARENTS",
         "base_link map odom", ["base_link has two parents: map by /slam, odom by /driver"]),
        ([heard("arm_base", "gripper")], "ROOTS", "odom arm_base",
         ["--frame-id odom --child-frame-id arm_base"]),
        ([LENS], "ROOTS", "odom camera_lnk", ["is camera_lnk a slip for camera_link?", "/camera"]),
        (NAMED, "UNKNOWN", "camera_lnk",
         ["/camera/image, /camera/info: the header names camera_lnk", "camera_link"]),
        ({"/scan": "lidar"}, "UNKNOWN", "lidar", ["--frame-id odom --child-frame-id lidar"]),
        ([replace(HEAD, delay_s=-0.5)], "CLOCK", "head", ["0.5 s in the future"]),
        ([replace(HEAD, delay_s=2.0)], "CLOCK", "head", ["2.0 s before it arrives"]),
        ([heard("base_link", "head", delay_s=NOW_S, stamp_s=0.0)], "CLOCK", "head",
         ["0.0 s, which cannot be the present time"]),
        ([replace(STATIC, moved=True)], "STATIC_MOVED", "head",
         ["head: comes on /tf_static with different numbers"]),
        ([BY_TURNS], "CONTESTED", "head",
         ["/ekf, /wheels publish head by turns, so that it jumps"]),
        ([replace(BY_TURNS, certain=False)], "CONTESTED", "head",
         ["several publishers send head by turns", "/ekf, /wheels"]),
        ([replace(BY_TURNS, publishers=("/ekf", "/ekf"))], "CONTESTED", "head",
         ["/ekf (2 of this name) publish head by turns"]),
        ([replace(HEAD, fault="its quaternion is all zeros", faults=7)], "NUMBERS", "head",
         ["head: its quaternion is all zeros; refused 7 of 100"]),
    ],
)  # fmt: skip
def test_what_is_wrong_with_frames_is_told_with_what_to_do(
    rows: list[FrameRow] | dict[str, str], trouble: str, frames: str, said: list[str]
) -> None:
    found = only(*ROBOT, named=rows) if isinstance(rows, dict) else only(*ROBOT, *rows)
    assert found.trouble is FrameTrouble[trouble]
    assert set(found.frames) == set(frames.split())
    assert all(words in f"{found.text}\n{found.advice}" for words in said)


@pytest.mark.parametrize(("certain", "said"), [(False, "one of /x, /y"), (True, "/x, /y")])
def test_a_loop_is_told_with_the_publisher_that_closes_it(certain: bool, said: str) -> None:
    closing = heard("c", "a", publishers=("/x", "/y"), certain=certain)
    (loop,) = find(heard("a", "b"), heard("b", "c"), closing)
    assert loop.trouble is FrameTrouble.LOOP
    assert loop.text.startswith("a → b → c and back to a")
    assert f"c → a out of {said}" in loop.advice


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

"""What is said to be wrong with the frames, and what to do about it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from graph.data import FrameRow
from space.buffer import Stamped
from space.transform import IDENTITY
from space.tree.finding import FrameFinding, FrameTrouble
from space.tree.findings import Surroundings, frame_findings
from space.tree.tree import FrameTree
from text.i18n import localized

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


def test_a_frame_that_has_fallen_silent_is_stale() -> None:
    found = only(*ROBOT, heard("base_link", "head", age_s=4.0))
    assert (found.trouble, found.frames) == (FrameTrouble.STALE, ("head",))
    assert found.text == "head: silent for 4 s"
    assert "/driver" in found.advice
    assert find(*ROBOT, heard("base_link", "head", age_s=4.0, hz=0.5)) == []
    assert find(*ROBOT, heard("base_link", "head", age_s=0.9, hz=100.0)) == []
    assert find(*ROBOT, heard("base_link", "head", age_s=4.0, hz=None)) != []
    gone = heard("base_link", "head", age_s=4.0, publishers=())
    assert "the node that published it has gone" in only(*ROBOT, gone).advice
    gone = replace(gone, gone="/neck")
    assert only(*ROBOT, gone).advice == "/neck, which published it, has gone: start it again"


def test_what_one_node_does_to_many_frames_is_said_once() -> None:
    arm = [heard("base_link", f"joint_{number}", age_s=5.0) for number in range(40)]
    found = only(*ROBOT, *arm)
    assert found.text == "joint_0, joint_1, joint_2 and 37 more: silent for 5 s"
    assert len(found.frames) == 40


def test_a_static_frame_whose_publisher_has_gone_is_not_heard_by_newcomers() -> None:
    found = only(*ROBOT, heard("base_link", "sonar", static=True, publishers=(), age_s=60.0))
    assert (found.trouble, found.frames) == (FrameTrouble.GONE, ("sonar",))
    assert found.text == "sonar: the node that published it on /tf_static has gone"
    row = heard("base_link", "sonar", static=True, publishers=(), gone="/state", age_s=60.0)
    found = only(*ROBOT, row)
    assert found.text == "sonar: /state, which published it on /tf_static, has gone"
    assert find(*ROBOT, heard("base_link", "sonar", static=True, age_s=6000.0)) == []
    assert find(*ROBOT, heard("base_link", "sonar", static=True, publishers=(), age_s=1.0)) == []


def test_two_parents_name_both_and_who_publishes_them() -> None:
    found = only(*ROBOT, heard("map", "odom"), heard("map", "base_link", publishers=("/slam",)))
    assert found.trouble is FrameTrouble.PARENTS
    assert found.frames == ("base_link", "map", "odom")
    assert found.text == "base_link has two parents: map by /slam, odom by /driver"


def test_a_loop_is_told_with_the_publisher_that_closes_it() -> None:
    closing = heard("c", "a", publishers=("/x", "/y"), certain=False)
    (loop,) = find(heard("a", "b"), heard("b", "c"), closing)
    assert loop.trouble is FrameTrouble.LOOP
    assert loop.text.startswith("a → b → c and back to a")
    assert "c → a out of one of /x, /y" in loop.advice
    (loop,) = find(heard("a", "b"), heard("b", "c"), replace(closing, certain=True))
    assert "c → a out of /x, /y" in loop.advice


def test_two_trees_are_told_with_the_command_that_joins_them() -> None:
    found = only(*ROBOT, heard("arm_base", "gripper"))
    assert (found.trouble, found.frames) == (FrameTrouble.ROOTS, ("odom", "arm_base"))
    assert "--frame-id odom --child-frame-id arm_base" in found.advice


def test_nothing_is_said_to_be_missing_while_static_frames_are_still_to_come() -> None:
    rows = (heard("odom", "base_link"), heard("arm_base", "gripper"))
    named = {"/image": "camera_link"}
    assert len(find(*rows, named=named)) == 2
    assert find(*rows, named=named, settling=True) == []


def test_a_slip_in_a_parents_name_is_found() -> None:
    found = only(*ROBOT, heard("camera_lnk", "lens", publishers=("/camera",)))
    assert "is camera_lnk a slip for camera_link?" in found.advice
    assert "/camera" in found.advice
    # These are two frames of most robots.
    assert "slip" not in only(*ROBOT, heard("base_footprint", "shadow")).advice


def test_a_frame_that_only_a_header_names_is_found_with_what_was_meant() -> None:
    found = only(*ROBOT, named={"/camera/image": "camera_lnk", "/camera/info": "camera_lnk"})
    assert (found.trouble, found.frames) == (FrameTrouble.UNKNOWN, ("camera_lnk",))
    assert found.text.startswith("/camera/image, /camera/info: the header names camera_lnk")
    assert "camera_link" in found.advice
    other = only(*ROBOT, named={"/scan": "lidar"})
    assert "--frame-id odom --child-frame-id lidar" in other.advice


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"delay_s": -0.5}, "0.5 s in the future"),
        ({"delay_s": 2.0}, "2.0 s before it arrives"),
        ({"delay_s": NOW_S - 12.5, "stamp_s": 12.5}, "12.5 s, which cannot be the present time"),
        ({"delay_s": NOW_S, "stamp_s": 0.0}, "0.0 s, which cannot be the present time"),
    ],
)
def test_stamps_of_another_clock_are_told(changes: dict[str, Any], said: str) -> None:
    found = only(*ROBOT, heard("base_link", "head", **changes))
    assert (found.trouble, found.frames) == (FrameTrouble.CLOCK, ("head",))
    assert said in found.text
    # A static frame holds whenever it was stamped.
    assert find(*ROBOT, heard("base_link", "head", static=True, **changes)) == []


def test_stamps_in_simulated_time_are_no_trouble() -> None:
    row = heard("odom", "base_link", stamp_s=12.5, delay_s=NOW_S)
    assert find(row) != []
    assert find(row, simulated=True) == []


def test_a_recording_in_simulated_time_is_no_trouble_while_all_agree() -> None:
    assert find(heard("odom", "base_link", stamp_s=12.5, delay_s=0.01)) == []


def test_a_frame_on_both_topics_is_told_with_both_publishers() -> None:
    found = only(*ROBOT, heard("odom", "base_link", static=True))
    assert found.trouble is FrameTrouble.BOTH
    assert "/tf by /driver and on /tf_static by /static" in found.text


def test_a_static_frame_that_moves_is_told() -> None:
    row = heard("base_link", "head", static=True, moved=True)
    found = only(*ROBOT, row)
    assert (found.trouble, found.frames) == (FrameTrouble.STATIC_MOVED, ("head",))
    assert found.text == "head: comes on /tf_static with different numbers"


def test_two_nodes_that_latch_one_frame_in_two_places_are_told() -> None:
    row = heard("base_link", "head", static=True, moved=True, publishers=("/one", "/other"))
    found = only(*ROBOT, row)
    assert found.trouble is FrameTrouble.STATIC_MOVED
    assert found.text == "/one, /other publish head on /tf_static with different numbers"
    found = only(*ROBOT, replace(row, certain=False))
    assert found.text == "head: comes on /tf_static with different numbers"
    assert "/one, /other" in found.advice


def test_a_frame_that_two_nodes_publish_by_turns_is_told() -> None:
    row = heard("base_link", "head", contested=True, publishers=("/ekf", "/wheels"))
    found = only(*ROBOT, row)
    assert found.trouble is FrameTrouble.CONTESTED
    assert found.text == "/ekf, /wheels publish head by turns, so that it jumps"
    assert "/ekf, /wheels" in found.advice
    found = only(*ROBOT, replace(row, certain=False))
    assert found.text == "several publishers send head by turns, so that it jumps"
    assert "/ekf, /wheels" in found.advice
    found = only(*ROBOT, replace(row, publishers=("/ekf", "/ekf")))
    assert found.text == "/ekf (2 of this name) publish head by turns, so that it jumps"


def test_numbers_that_are_refused_are_told_with_how_many() -> None:
    row = heard("base_link", "head", fault="its quaternion is all zeros", faults=7)
    found = only(*ROBOT, row)
    assert (found.trouble, found.frames) == (FrameTrouble.NUMBERS, ("head",))
    assert found.text == "head: its quaternion is all zeros; refused 7 of 100"


def test_a_frame_without_a_name_is_told() -> None:
    row = heard("odom", "", fault="its child_frame_id is empty", faults=100)
    assert only(*ROBOT, row).text.startswith("a frame without a name: its child_frame_id is empty")


def test_a_slash_in_front_is_told() -> None:
    found = only(*ROBOT, heard("base_link", "head", slashed=True))
    assert (found.trouble, found.frames) == (FrameTrouble.SLASH, ("head",))


def test_other_topics_with_frames_are_told_with_the_remapping() -> None:
    found = only(*ROBOT, elsewhere={"/ns/tf_static": 0})
    assert found.trouble is FrameTrouble.ELSEWHERE
    assert "/ns/tf_static too, which nobody here listens to" in found.text
    assert "-r /ns/tf_static:=/tf_static" in found.advice
    assert "does not listen by itself" in only(*ROBOT, elsewhere={"/ns/tf": 2}).text


def test_a_static_topic_that_newcomers_do_not_hear_is_told() -> None:
    found = only(*ROBOT, volatile=("/camera",))
    assert found.trouble is FrameTrouble.VOLATILE
    assert found.text.startswith("/camera: publishes /tf_static without transient_local")


def test_too_many_frames_are_told_first() -> None:
    rows = [heard("odom", f"frame_{number}", age_s=9.0) for number in range(10)]
    assert [one.trouble for one in find(*rows, most=10)] == [FrameTrouble.FULL, FrameTrouble.STALE]


def test_hostile_names_are_harmless_in_sentences() -> None:
    found = find(heard("\x1b[31m", "\x1b[2J", age_s=9.0), named={"/a": "\x1b]0;x\a"})
    assert all("\x1b" not in one.text + one.advice for one in found)
    assert len(found) == 2

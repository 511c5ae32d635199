"""`deck frames` beside real publishers: the tree, what is wrong with it, and the exit code."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator

import pytest
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from tests.deck_process import deck
from tests.ros.peer import LATCHED, Peer


@pytest.fixture
def peer(ros_domain: int) -> Iterator[Peer]:
    with Peer(ros_domain, "camera_tf") as made:
        yield made


def latch(peer: Peer, *edges: tuple[str, str]) -> None:
    transforms = []
    for parent, child in edges:
        made = TransformStamped(child_frame_id=child)
        made.header.frame_id = parent
        made.transform.translation.x = 0.15
        transforms.append(made)
    peer.publisher("/tf_static", TFMessage, LATCHED).publish(TFMessage(transforms=transforms))


def test_a_tree_in_order_is_printed(peer: Peer) -> None:
    latch(peer, ("base_link", "camera_link"), ("camera_link", "lens"))
    run = deck("frames", "--lang", "en")
    assert run.finish() == 0
    # The age is that of the moment at which it was latched.
    said = [re.sub(r" +(<? ?[0-9]+ s)? +", " ", line) for line in run.lines]
    assert said == [
        "FRAME RATE AGE PUBLISHER",
        "base_link root",
        "└ camera_link static camera_tf",
        " └ lens static camera_tf",
        "✓ nothing is wrong with the frames",
    ]


def test_json_tells_programs_what_is_wrong(peer: Peer) -> None:
    latch(peer, ("base_link", "camera_link"), ("odom", "camera_link"))
    run = deck("frames", "--json")
    assert run.finish() == 1
    told = json.loads("\n".join(run.lines))
    rows = {(row["parent"], row["frame"]): row for row in told["frames"]}
    assert rows["base_link", "camera_link"]["translation"] == [0.15, 0.0, 0.0]
    assert rows["odom", "camera_link"]["publishers"] == ["/camera_tf"]
    assert rows["odom", "camera_link"]["static"]
    (found,) = told["findings"]
    assert (found["key"], found["frames"]) == ("two parents", ["camera_link", "base_link", "odom"])
    assert found["mend"]


def test_no_frames_are_no_success(ros_domain: int) -> None:
    run = deck("frames", "--for", "0.5", "--lang", "en")
    assert run.finish() == 1
    assert run.lines == [f"no frames in domain {ros_domain}"]

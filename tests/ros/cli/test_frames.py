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

pytestmark = pytest.mark.nightly


@pytest.fixture
def peer(ros_domain: int) -> Iterator[Peer]:
    with Peer(ros_domain, "camera_tf") as made:
        yield made


def latch(peer: Peer, *edges: tuple[str, str], x_m: float = 0.15) -> None:
    transforms = []
    for parent, child in edges:
        made = TransformStamped(child_frame_id=child)
        made.header.frame_id = parent
        made.transform.translation.x = x_m
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
    assert rows["odom", "camera_link"]["certain"]
    assert rows["odom", "camera_link"]["static"]
    (found,) = told["findings"]
    assert (found["key"], found["frames"]) == ("two parents", ["camera_link", "base_link", "odom"])
    assert found["mend"]


def test_each_of_several_publishers_is_named(peer: Peer, ros_domain: int) -> None:
    with Peer(ros_domain, "driver") as driver, Peer(ros_domain, "rival") as rival:
        latch(peer, ("base_link", "camera_link"))
        latch(driver, ("odom", "base_link"))
        latch(rival, ("base_link", "camera_link"), x_m=0.2)
        run = deck("frames", "--lang", "en")
        assert run.finish() == 1
        said = [re.sub(r" +(<? ?[0-9]+ s)? +", " ", line) for line in run.lines]
    assert said[2:4] == ["└ base_link static driver", " └ camera_link static camera_tf +1"]
    assert said[4].startswith(
        "✗ /camera_tf, /rival publish camera_link on /tf_static with different"
    )


def test_no_frames_are_no_success(ros_domain: int) -> None:
    run = deck("frames", "--for", "0.5", "--lang", "en")
    assert run.finish() == 1
    assert run.lines == [
        f"no frames in domain {ros_domain}",
        "only this machine was looked at: --discovery subnet looks on the network, too",
    ]

"""The words `now` and `auto`: the time of sending, each time anew, and nowhere else."""

from __future__ import annotations

import time
from typing import Any

import pytest
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Path
from std_msgs.msg import Header, String
from tf2_msgs.msg import TFMessage

from graph.messages.dated import draft
from graph.messages.making import FieldError
from tests.ros.observing import Watcher
from tests.ros.peer import Peer
from tests.waiting import wait_until


def ns(stamp: Any) -> int:
    seconds: int = stamp.sec
    nanoseconds: int = stamp.nanosec
    return seconds * 1_000_000_000 + nanoseconds


@pytest.mark.parametrize("header", ["auto", {"stamp": "now"}])
def test_it_is_the_time_of_each_sending(header: Any) -> None:
    made = draft(PoseStamped, {"header": header, "pose": {"position": {"x": 1.0}}})
    last = time.time_ns()
    for _sending in range(3):
        sent = made.dated()
        assert last <= ns(sent.header.stamp) <= time.time_ns()
        assert sent.pose.position.x == 1.0
        last = ns(sent.header.stamp)


def test_other_fields_of_the_header_stay() -> None:
    sent = draft(Header, {"stamp": "now", "frame_id": "map"}).dated()
    assert sent.frame_id == "map"
    assert ns(sent.stamp) > 0


def test_it_reaches_headers_in_lists() -> None:
    path = draft(Path, {"header": {"frame_id": "map"}, "poses": [{"header": "auto"}, {}]}).dated()
    assert [ns(pose.header.stamp) > 0 for pose in path.poses] == [True, False]
    assert ns(path.header.stamp) == 0
    frames = draft(TFMessage, {"transforms": [{"header": {"stamp": "now"}}]}).dated()
    assert ns(frames.transforms[0].header.stamp) > 0


def test_a_text_may_be_one_of_the_words() -> None:
    assert draft(String, {"data": "now"}).dated().data == "now"
    assert draft(Header, {"frame_id": "auto"}).dated().frame_id == "auto"


@pytest.mark.parametrize(
    ("header", "field"),
    [("now", "header"), ({"stamp": "auto"}, "header.stamp"), ({"stamp": "later"}, "header.stamp")],
)
def test_a_word_in_the_wrong_place_is_refused(header: Any, field: str) -> None:
    with pytest.raises(FieldError) as caught:
        draft(PoseStamped, {"header": header})
    assert caught.value.field == field


def test_what_is_published_again_and_again_is_dated_anew(watcher: Watcher, peer: Peer) -> None:
    stamps: list[int] = []

    def take(pose: PoseStamped) -> None:
        stamps.append(ns(pose.header.stamp))

    peer.node.create_subscription(PoseStamped, "/goal", take, 50)
    before = time.time_ns()
    watcher.observer.start_publishing(
        "/goal", "geometry_msgs/msg/PoseStamped", {"header": "auto"}, 50.0
    ).result(30)
    wait_until(lambda: len(stamps) > 5, "some messages")
    assert before < stamps[0]
    assert stamps == sorted(set(stamps))

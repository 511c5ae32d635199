"""What was sent once has no rate, however often Deck hears it again."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import pytest

from tests.ros.observing import Peer, Watcher, let_updates_come
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

FLOAT, TRANSFORMS = "std_msgs/msg/Float32", "tf2_msgs/msg/TFMessage"
LATCHED = "transient_local"


@pytest.fixture
def peer(ros_domain: int) -> Iterator[Peer]:
    peer = Peer("sender", ros_domain)
    yield peer
    peer.close()


def heard(watcher: Watcher, topic: str) -> int:
    row = watcher.row(topic)
    return row.count if row is not None else 0


def shows_frames(watcher: Watcher, wanted: bool) -> bool:
    return bool(watcher.update.frames) is wanted


def test_a_static_transform_that_screens_ask_for_again_and_again_has_none(
    peer: Peer, watcher: Watcher
) -> None:
    peer.advertise("/tf_static", type_name=TRANSFORMS, durability=LATCHED)
    peer.publish("/tf_static", value={"transforms": [{"child_frame_id": "a"}]})
    watcher.observer.measure(True)
    wait_until(lambda: heard(watcher, "/tf_static") == 1, "it was heard")
    for _round in range(3):
        for wanted in (True, False):
            watcher.observer.watch_frames(wanted)
            wait_until(partial(shows_frames, watcher, wanted), f"frames: {wanted}")
            let_updates_come(watcher, 5)
    row = watcher.row("/tf_static")
    assert row is not None
    assert (row.hz, row.bytes_per_s, row.count, row.jitter_s) == (None, None, 1, None)


def test_a_latched_topic_that_is_subscribed_anew_has_none(
    peer: Peer, watcher: Watcher, ros_domain: int
) -> None:
    peer.advertise("/once", type_name=FLOAT, durability=LATCHED)
    peer.publish("/once", value={"data": 1.0})
    watcher.observer.watch(["/once"])
    wait_until(lambda: heard(watcher, "/once") == 1, "it was heard")
    other = Peer("other", ros_domain)
    for _round in range(2):
        # Whoever latches nothing changes what Deck asks for.
        other.advertise("/once", type_name=FLOAT)
        watcher.wait_for("/once", lambda row: row.publishers == 2, "two publishers")
        let_updates_come(watcher, 5)
        other.withdraw("/once")
        watcher.wait_for("/once", lambda row: row.publishers == 1, "one publisher")
        let_updates_come(watcher, 10)
    row = watcher.row("/once")
    assert row is not None
    assert (row.hz, row.count) == (None, 1)
    other.close()


def test_several_that_were_sent_once_each_before_deck_came_have_none(
    peer: Peer, ros_domain: int
) -> None:
    others = [peer, Peer("other", ros_domain), Peer("third", ros_domain)]
    for each in others:
        each.advertise("/once", type_name=FLOAT, durability=LATCHED)
        each.publish("/once", value={"data": 1.0})
    watcher = Watcher(ros_domain)
    watcher.observer.watch(["/once"])
    rates = set()
    wait_until(lambda: heard(watcher, "/once") == len(others), "all were heard")
    for _look in range(10):
        row = watcher.row("/once")
        assert row is not None
        rates.add(row.hz)
        let_updates_come(watcher, 1)
    assert rates == {None}
    watcher.close()
    for each in others[1:]:
        each.close()


def test_a_latched_topic_that_is_published_regularly_has_its_rate(
    peer: Peer, watcher: Watcher
) -> None:
    peer.advertise("/often", type_name=FLOAT, durability=LATCHED)
    peer.repeat("/often", value={"data": 1.0}, hz=10)
    watcher.observer.watch(["/often"])
    row = watcher.wait_for("/often", lambda row: row.hz and abs(row.hz - 10.0) < 0.5, "its rate")
    assert row.hz == pytest.approx(10.0, abs=0.5)

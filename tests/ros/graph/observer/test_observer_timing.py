"""Jitter, latency and lost messages of real peers that sway, stamp, and send too much at once."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from graph.data import TopicRow
from tests.ros.observing import Peer, Watcher, let_updates_come
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

FLOAT = "std_msgs/msg/Float32"
JOINTS = "sensor_msgs/msg/JointState"
IMAGE = "sensor_msgs/msg/Image"
MEGABYTE = 1_000_000


@pytest.fixture
def watcher(ros_domain: int) -> Iterator[Watcher]:
    watcher = Watcher(ros_domain)
    watcher.observer.measure(all_topics=True)
    yield watcher
    watcher.close()


@pytest.fixture
def peer(ros_domain: int) -> Iterator[Peer]:
    peer = Peer("swaying", ros_domain)
    yield peer
    peer.close()


def test_a_publisher_that_sways_has_the_jitter_that_it_has(watcher: Watcher, peer: Peer) -> None:
    peer.advertise("/sways", type_name=FLOAT)
    peer.advertise("/steady", type_name=FLOAT)
    peer.repeat("/sways", value={"data": 1.0}, hz=10, sway_s=0.04)
    peer.repeat("/steady", value={"data": 1.0}, hz=10)

    def is_told(row: TopicRow) -> bool:
        return row.jitter_s is not None and abs(row.jitter_s - 0.04) < 0.01

    row = watcher.wait_for("/sways", is_told, "its jitter")
    assert row.latency_s is None
    watcher.wait_for("/steady", lambda r: r.jitter_s is not None and r.jitter_s < 0.01, "calm")


def test_the_delay_since_a_stamp_is_told_unless_it_is_of_another_clock(
    watcher: Watcher, peer: Peer
) -> None:
    for topic, ago_s in (("/late", 0.25), ("/another_clock", 3600.0), ("/early", -0.5)):
        peer.advertise(topic, type_name=JOINTS)
        peer.repeat_stamped(topic, hz=20, ago_s=ago_s)
    peer.advertise("/stampless", type_name=JOINTS)
    peer.repeat("/stampless", value={"name": ["a"]}, hz=20)
    row = watcher.wait_for("/late", lambda row: row.latency_s is not None, "a latency")
    assert row.latency_s == pytest.approx(0.25, abs=0.1)
    row = watcher.wait_for("/early", lambda row: row.latency_s is not None, "a latency")
    assert row.latency_s == pytest.approx(-0.5, abs=0.1)
    for topic in ("/another_clock", "/stampless"):
        row = watcher.wait_for(topic, lambda row: row.jitter_s is not None, "many messages")
        assert row.latency_s is None


FEW = 3
"""Messages of which the middleware itself loses track when the machine is busy."""


def test_what_is_lost_on_the_way_is_counted_and_the_rest_is_not(
    watcher: Watcher, peer: Peer
) -> None:
    """Best effort, and more at once than any buffer on the way holds."""
    peer.advertise("/flood", type_name=IMAGE, reliability="best_effort", depth=5)

    def listens() -> str:
        seen = (watcher.updates, watcher.row("/flood"), watcher.update.error)
        return f"Deck listens once, but {peer.listeners('/flood')} do; it sees {seen}"

    wait_until(lambda: peer.listeners("/flood") == 1, listens)
    sent = 0

    def send(times: int, size: int = MEGABYTE) -> TopicRow:
        nonlocal sent
        peer.burst("/flood", times=times, pad=size)
        sent += times
        let_updates_come(watcher, 3)
        row = watcher.row("/flood")
        assert row is not None
        return row

    def first() -> TopicRow | None:
        row = send(1)
        return row if row.count else None

    # Nobody can know of those before the first that comes; on a busy machine several come with it.
    known = wait_until(first, "a first message")
    unknown = sent - known.count - (known.lost or 0)
    assert send(60).count < sent - unknown, "the flood was none"

    def most_are_accounted_for() -> bool:
        """A loss shows with the first message that comes after it; a small one comes for sure."""
        row = send(1, size=1)
        told = row.count + (row.lost or 0)
        return bool(row.lost) and sent / 2 < told <= sent + FEW

    def account() -> str:
        return f"{watcher.row('/flood')} makes up the {sent} sent but {unknown}"

    wait_until(most_are_accounted_for, account, every_s=0.3)


def test_our_own_short_queue_and_what_was_sent_before_us_lose_nothing(
    ros_domain: int, peer: Peer
) -> None:
    peer.advertise("/images", type_name=IMAGE, depth=10, durability="transient_local")
    peer.burst("/images", times=20, pad=MEGABYTE)
    watcher = Watcher(ros_domain, period_s=0.5)
    try:
        watcher.observer.measure(all_topics=True)
        watcher.wait_for("/images", lambda row: row.count, "the latched ones")
        peer.repeat("/images", value={}, pad=1000, hz=40)
        row = watcher.wait_for("/images", lambda row: row.count > 100, "more than the queue holds")
        assert row.lost == 0
    finally:
        watcher.close()

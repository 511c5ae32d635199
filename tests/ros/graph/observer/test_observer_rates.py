"""Rates: right within 2 % for all topics at once, images included; nothing is taken unasked."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from graph.data import TopicRow
from tests.ros.observing import Peer, Watcher, let_updates_come
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

FLOAT = "std_msgs/msg/Float32"
FLOATS = [f"/load/float_{number}" for number in range(10)]
IMAGE = "/load/image"
IMAGE_BYTES = 640 * 480 * 3
EXPECTED_HZ = {**dict.fromkeys(FLOATS, 50.0), IMAGE: 30.0}


@pytest.fixture(scope="module")
def load(module_domain: int) -> Iterator[Peer]:
    """Ten Float32 topics at 50 Hz and one 640x480 image topic at 30 Hz."""
    peer = Peer("load", module_domain)
    for topic in FLOATS:
        peer.advertise(topic, type_name=FLOAT)
        peer.repeat(topic, value={"data": 1.5}, hz=50)
    peer.advertise(IMAGE, type_name="sensor_msgs/msg/Image")
    image = {"height": 480, "width": 640, "step": 1920, "encoding": "bgr8"}
    peer.repeat(IMAGE, value=image, pad=IMAGE_BYTES, hz=30)
    yield peer
    peer.close()


@pytest.mark.usefixtures("load")
@pytest.mark.parametrize("period_s", [0.1, 0.25, 0.5])
def test_all_eleven_rates_are_right_whatever_the_period(
    module_domain: int, period_s: float
) -> None:
    watcher = Watcher(module_domain, period_s=period_s)
    watcher.observer.measure(all_topics=True)
    try:
        wait_until(lambda: all(_is_right(watcher.row(t), t) for t in EXPECTED_HZ), "right rates")
        image = watcher.row(IMAGE)
        assert image is not None
        assert image.bytes_per_s == pytest.approx(30 * IMAGE_BYTES, rel=0.03)
        assert image.age_s is not None
        assert image.age_s < 2.0
        assert watcher.samples == {}
    finally:
        watcher.close()


def _is_right(row: TopicRow | None, topic: str) -> bool:
    return row is not None and row.hz is not None and abs(row.hz / EXPECTED_HZ[topic] - 1) < 0.02


@pytest.mark.usefixtures("load")
def test_two_publishers_of_large_messages_are_counted_together(module_domain: int) -> None:
    second = Peer("second", module_domain)
    watcher = Watcher(module_domain, period_s=0.25)
    watcher.observer.watch([IMAGE])
    watcher.wait_for(IMAGE, lambda row: _is_right(row, IMAGE), "one alone")
    second.advertise(IMAGE, type_name="sensor_msgs/msg/Image")
    second.repeat(IMAGE, value={"height": 480}, pad=IMAGE_BYTES, hz=20)
    try:
        row = watcher.wait_for(
            IMAGE, lambda row: row.hz and abs(row.hz / 50 - 1) < 0.02, "30 and 20 make 50"
        )
        assert row.publishers == 2
    finally:
        watcher.close()
        second.close()


def test_a_topic_is_subscribed_only_while_somebody_looks(load: Peer, module_domain: int) -> None:
    watcher = Watcher(module_domain)
    try:
        watcher.wait_for(IMAGE, lambda row: row.publishers == 1, "is known")
        assert load.listeners(IMAGE) == 0
        row = watcher.row(IMAGE)
        assert row is not None
        assert (row.measured, row.hz) == (False, None)
        watcher.observer.watch([IMAGE])
        wait_until(lambda: load.listeners(IMAGE) == 1, "watched")
        assert load.listeners(FLOATS[0]) == 0
        watcher.observer.watch([])
        wait_until(lambda: load.listeners(IMAGE) == 0, "left alone again")
        watcher.observer.measure(all_topics=True)
        wait_until(lambda: load.listeners(FLOATS[0]) == 1, "measured")
        watcher.observer.measure(all_topics=False)
        assert load.listeners(FLOATS[0]) == 1, "a light one is kept for whoever comes back"
        wait_until(lambda: load.listeners(FLOATS[0]) == 0, "not measured any more", within_s=90)
    finally:
        watcher.close()


def test_period_can_be_changed_at_work(load: Peer, module_domain: int) -> None:
    watcher = Watcher(module_domain, period_s=60.0)
    try:
        watcher.observer.watch([FLOATS[0]])
        watcher.observer.period_s = 0.05
        let_updates_come(watcher, 20)
        assert load.process.poll() is None
    finally:
        watcher.close()


def test_tabs_that_change_cost_no_subscription_each_time(load: Peer, module_domain: int) -> None:
    """The middleware keeps something of each, and rclpy did so, too: 8 kB for a change of tab."""
    watcher = Watcher(module_domain)
    try:
        watcher.observer.watch(FLOATS[:1])
        wait_until(lambda: load.listeners(FLOATS[0]) == 1, "watched")
        first = watcher.wait_for(FLOATS[0], lambda row: row.count > 5, "counted").count
        for _change in range(3):
            watcher.observer.watch([IMAGE])
            wait_until(lambda: load.listeners(IMAGE) == 1, "the picture watched")
            watcher.observer.watch(FLOATS[:1])
            wait_until(lambda: load.listeners(IMAGE) == 0, "a large one is given up at once")
        row = watcher.row(FLOATS[0])
        assert row is not None
        assert row.count > first, "counted on: it is the same subscription"
        assert load.listeners(FLOATS[0]) == 1
    finally:
        watcher.close()

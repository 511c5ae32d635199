"""What the observer shows of a graph: its topics, rates, pictures, nodes, services, QoS."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from functools import partial
from typing import Any

import pytest

from graph.data import EndpointInfo, ServiceRow, TopicRow, Trouble
from graph.heavy_types import COMPRESSED_IMAGE, IMAGE
from graph.housekeeping import is_housekeeping
from tests.ros.observing import ROOT, Peer, Watcher, let_updates_come
from tests.waiting import wait_until

NIGHTLY = pytest.mark.nightly
FLOAT = "std_msgs/msg/Float32"


STRING = "std_msgs/msg/String"
ADD = "example_interfaces/srv/AddTwoInts"
FLOATS = [f"/load/float_{number}" for number in range(10)]
LOAD = "/load/image"
IMAGE_BYTES = 640 * 480 * 3
EXPECTED_HZ = {**dict.fromkeys(FLOATS, 50.0), LOAD: 30.0}
RAW = "/eye/image_raw"


BLACK = {"header": {"frame_id": "eye_link"}, "height": 2, "width": 2, "step": 6, "encoding": "rgb8", "data": [0] * 12}


@pytest.mark.parametrize("reliability", ["reliable", "best_effort"])
@pytest.mark.parametrize("durability", ["volatile", "transient_local"])
def test_every_kind_of_publisher_is_heard(talker: Peer, watcher: Watcher, reliability: str, durability: str) -> None:
    topic = f"/kind/{reliability}/{durability}"
    talker.advertise(topic, type_name=FLOAT, reliability=reliability, durability=durability)
    talker.repeat(topic, value={"data": 2.5}, hz=20)
    watcher.want(watched=[topic])
    wait_until(lambda: watcher.of(topic), f"a sample of {topic}")
    assert watcher.of(topic)[0] == 2.5
    row = watcher.wait_for(topic, lambda row: row.measured, "is measured")
    assert (row.publishers, row.subscribers, row.type_names) == (1, 0, (FLOAT,))
    assert row.published_by[0].reliability == reliability
    assert row.published_by[0].durability == durability
    talker.withdraw(topic)


def test_only_the_newest_is_decoded_of_a_watched_topic_and_all_of_a_followed_one(
    talker: Peer, watcher: Watcher
) -> None:
    for topic in ("/burst/watched", "/burst/followed"):
        talker.advertise(topic, type_name="std_msgs/msg/Int32", depth=200)
    watcher.want(period_s=0.5)
    watcher.want(watched=["/burst/watched"])
    watcher.want(followed=["/burst/followed"])
    for topic in ("/burst/watched", "/burst/followed"):
        wait_until(partial(talker.listeners, topic), f"{topic} subscribed")
        talker.publish(topic, value={"data": "NUMBER"}, times=100)
    wait_until(lambda: watcher.of("/burst/followed")[-1:] == [99], "the last followed")
    wait_until(lambda: watcher.of("/burst/watched")[-1:] == [99], "the last watched")
    watcher.want(period_s=0.1)
    assert watcher.of("/burst/followed") == list(range(100))
    assert len(watcher.of("/burst/watched")) < 10
    watcher.wait_for("/burst/watched", lambda row: row.count == 100, "all counted")


def test_a_publisher_and_a_subscriber_that_do_not_fit_are_named(talker: Peer, watcher: Watcher) -> None:
    talker.advertise("/misfit", type_name=FLOAT, reliability="best_effort")
    talker.listen("/misfit", type_name=FLOAT, reliability="reliable")
    talker.repeat("/misfit", value={"data": 1.0}, hz=20)
    watcher.want(watched=["/misfit"])
    row = watcher.wait_for("/misfit", lambda row: row.trouble is Trouble.QOS_MISMATCH, "misfit")
    assert "Let /talker offer reliable, or let /talker ask for best_effort." in row.detail
    wait_until(lambda: watcher.of("/misfit"), "Deck itself hears it")


def test_a_publisher_that_comes_back_with_another_qos_or_type_is_heard_again(talker: Peer, watcher: Watcher) -> None:
    watcher.want(watched=["/changing"])
    talker.advertise("/changing", type_name=FLOAT)
    talker.repeat("/changing", value={"data": 1.0}, hz=20)
    wait_until(lambda: watcher.of("/changing")[-1:] == [1.0], "the first")
    talker.withdraw("/changing")
    talker.advertise("/changing", type_name=FLOAT, reliability="best_effort")
    talker.repeat("/changing", value={"data": 2.0}, hz=20)
    wait_until(lambda: watcher.of("/changing")[-1:] == [2.0], "the best-effort one")
    talker.withdraw("/changing")
    talker.advertise("/changing", type_name=STRING)
    talker.repeat("/changing", value={"data": "three"}, hz=20)
    wait_until(lambda: watcher.of("/changing")[-1:] == ["three"], "the one of another type")


# ---------------------------------------------------------------- who talks to whom


@pytest.fixture(scope="module")
def peers(module_domain: int) -> Iterator[list[Peer]]:
    peers = [Peer("driver", module_domain), Peer("person", module_domain)]
    yield peers
    for peer in peers:
        peer.close()


def the_end(watcher: Watcher, topic: str, side: str) -> EndpointInfo:
    """The only publisher or subscription of a topic."""
    row = watcher.wait_for(topic, lambda row: len(getattr(row, side)) == 1, side)
    (end,) = getattr(row, side)
    assert isinstance(end, EndpointInfo)
    return end


def test_every_policy_of_an_endpoint_is_told(watcher: Watcher, peers: list[Peer]) -> None:
    peers[0].advertise(
        "/a",
        type_name=FLOAT,
        reliability="best_effort",
        durability="transient_local",
        liveliness="manual_by_topic",
        deadline=0.5,
        lifespan=2.0,
        liveliness_lease_duration=3.0,
    )
    peers[1].listen("/b", type_name=FLOAT, deadline=1.5)
    told = the_end(watcher, "/a", "published_by")
    assert (told.node, told.type_name) == ("/driver", FLOAT)
    assert (told.reliability, told.durability) == ("best_effort", "transient_local")
    assert told.deadline_s == pytest.approx(0.5)
    assert told.lifespan_s == pytest.approx(2.0)
    assert told.lease_s == pytest.approx(3.0)
    assert told.liveliness == "manual_by_topic"
    # Fast DDS announces neither.
    assert (told.history, told.depth) == ("", 0)
    told = the_end(watcher, "/b", "subscribed_by")
    assert told.deadline_s == pytest.approx(1.5)
    assert (told.lifespan_s, told.lease_s, told.liveliness) == (None, None, "automatic")


def test_services_name_those_who_serve_and_those_who_call(watcher: Watcher, peers: list[Peer]) -> None:
    peers[0].serve("/add")
    peers[1].use("/add")
    peers[1].use("/nobody_serves_it")
    wait_until(lambda: (row := watcher.node("/person")) and len(row.clients) == 2, "both clients")
    person, driver = watcher.node("/person"), watcher.node("/driver")
    assert person is not None
    assert driver is not None
    assert person.clients == ("/add", "/nobody_serves_it")
    assert (driver.services.count("/add"), driver.clients) == (1, ())
    added = [row for row in watcher.update.services if not is_housekeeping(row.name)]
    assert added == [ServiceRow("/add", (ADD,), ("/driver",))]
    peers[1].stop_using("/add")
    wait_until(lambda: (row := watcher.node("/person")) and row.clients == ("/nobody_serves_it",), "one client left")


# ---------------------------------------------------------------- rates


@pytest.fixture(scope="module")
def load(module_domain: int) -> Iterator[Peer]:
    """Ten Float32 topics at 50 Hz and one 640x480 image topic at 30 Hz."""
    peer = Peer("load", module_domain)
    for topic in FLOATS:
        peer.advertise(topic, type_name=FLOAT)
        peer.repeat(topic, value={"data": 1.5}, hz=50)
    peer.advertise(LOAD, type_name="sensor_msgs/msg/Image")
    image = {"height": 480, "width": 640, "step": 1920, "encoding": "bgr8"}
    peer.repeat(LOAD, value=image, pad=IMAGE_BYTES, hz=30)
    yield peer
    peer.close()


def _is_right(row: TopicRow | None, topic: str) -> bool:
    return row is not None and row.hz is not None and abs(row.hz / EXPECTED_HZ[topic] - 1) < 0.02


@NIGHTLY
@pytest.mark.usefixtures("load")
def test_all_eleven_rates_are_right(module_domain: int) -> None:
    watcher = Watcher(module_domain)
    watcher.want(all_topics=True, period_s=0.25)
    try:
        wait_until(lambda: all(_is_right(watcher.row(t), t) for t in EXPECTED_HZ), "right rates")
        image = watcher.row(LOAD)
        assert image is not None
        assert image.bytes_per_s == pytest.approx(30 * IMAGE_BYTES, rel=0.03)
        assert image.age_s is not None
        assert image.age_s < 2.0
        assert watcher.samples == {}
    finally:
        watcher.close()


@NIGHTLY
def test_a_topic_is_subscribed_only_while_somebody_looks(load: Peer, module_domain: int) -> None:
    watcher = Watcher(module_domain)
    try:
        watcher.wait_for(LOAD, lambda row: row.publishers == 1, "is known")
        assert load.listeners(LOAD) == 0
        row = watcher.row(LOAD)
        assert row is not None
        assert (row.measured, row.hz) == (False, None)
        watcher.want(watched=[LOAD])
        wait_until(lambda: load.listeners(LOAD) == 1, "watched")
        assert load.listeners(FLOATS[0]) == 0
        watcher.want(watched=[])
        wait_until(lambda: load.listeners(LOAD) == 0, "left alone again")
        watcher.want(all_topics=True)
        wait_until(lambda: load.listeners(FLOATS[0]) == 1, "measured")
        watcher.want(all_topics=False)
        assert load.listeners(FLOATS[0]) == 1, "a light one is kept for whoever comes back"
        wait_until(lambda: load.listeners(FLOATS[0]) == 0, "not measured any more", within_s=90)
    finally:
        watcher.close()


def test_while_nobody_looks_slow_topics_are_measured_and_costly_ones_left_alone(
    talker: Peer, watcher: Watcher
) -> None:
    slow, fast, large = "/passing/slow", "/passing/fast", "/passing/large"
    for topic, hz in ((slow, 2.0), (fast, 60.0)):
        talker.advertise(topic, type_name=FLOAT)
        talker.repeat(topic, value={"data": 1.0}, hz=hz)
    talker.advertise(large, type_name="sensor_msgs/msg/PointCloud2")
    watcher.want(all_topics=True, all_images=False, all_fast=False)
    watcher.wait_for(slow, lambda row: row.hz is not None, "has a rate")
    watcher.wait_for(fast, lambda row: not row.measured and talker.listeners(fast) == 0, "was found to be fast")
    row = watcher.row(large)
    assert row is not None
    assert not row.measured
    watcher.want(all_images=True, all_fast=True)
    watcher.wait_for(fast, lambda row: row.hz is not None, "is measured for whoever looks")
    assert watcher.wait_for(slow, lambda row: row.hz is not None, "has its rate still").count > 1
    for topic in (slow, fast, large):
        talker.withdraw(topic)


# ---------------------------------------------------------------- pictures


@pytest.fixture
def camera(module_domain: int) -> Iterator[Peer]:
    peer = Peer("eye", module_domain)
    peer.advertise(RAW, type_name=IMAGE)
    peer.repeat(RAW, value=BLACK, hz=20)
    yield peer
    peer.close()


def kinds(watcher: Watcher) -> set[str]:
    return {sample.type_name for sample in watcher.samples.get(RAW, ())}


@NIGHTLY
def test_the_relay_listens_while_somebody_looks(camera: Peer, watcher: Watcher, module_domain: int) -> None:
    del camera
    relayed = f"{RAW}/_deck/compressed"
    with subprocess.Popen(
        [sys.executable, "-m", "graph.picture_relay", json.dumps([module_domain, "localhost"])],
        cwd=ROOT,
        stdin=subprocess.PIPE,
    ) as relay:
        assert relay.stdin is not None
        try:
            watcher.want(all_topics=True)
            row: Any = watcher.wait_for(relayed, lambda row: row.publishers == 1, "is offered")
            let_updates_come(watcher, 5)
            assert not row.measured, "a list of topics asks for no pictures"
            watcher.want(all_topics=False)
            watcher.want(pictures=[RAW])
            wait_until(lambda: COMPRESSED_IMAGE in kinds(watcher), "relayed pictures")
            sample = watcher.samples[RAW][-1]
            assert sample.value["format"] == "rgb8; jpeg compressed bgr8; of 2x2"
            assert sample.value["header"]["frame_id"] == "eye_link"  # type: ignore[index, call-overload]
        finally:
            relay.stdin.close()
        assert relay.wait(20) == 0
    watcher.wait_for(RAW, lambda row: row.measured, "is raw again")

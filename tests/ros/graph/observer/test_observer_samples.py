"""What the observer shows of topics: any QoS, newest or all, and a word where there is nothing."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from functools import partial

import pytest

from graph.data import Trouble
from graph.messages.types import load_message
from tests.ros.observing import Peer, Watcher, let_updates_come
from tests.waiting import wait_until

FLOAT = "std_msgs/msg/Float32"
CDR_OF_EMPTY_ODOMETRY = 708
STRING = "std_msgs/msg/String"


@pytest.fixture(scope="module")
def peer(module_domain: int) -> Iterator[Peer]:
    peer = Peer("talker", module_domain)
    yield peer
    peer.close()


@pytest.fixture
def watcher(module_watcher: Watcher) -> Iterator[Watcher]:
    yield module_watcher
    module_watcher.observer.watch(())
    module_watcher.observer.follow(())
    module_watcher.observer.measure(all_topics=False)


@pytest.mark.parametrize("reliability", ["reliable", "best_effort"])
@pytest.mark.parametrize("durability", ["volatile", "transient_local"])
def test_every_kind_of_publisher_is_heard(
    peer: Peer, watcher: Watcher, reliability: str, durability: str
) -> None:
    topic = f"/kind/{reliability}/{durability}"
    peer.advertise(topic, type_name=FLOAT, reliability=reliability, durability=durability)
    peer.repeat(topic, value={"data": 2.5}, hz=20)
    watcher.observer.watch([topic])
    wait_until(lambda: watcher.of(topic), f"a sample of {topic}")
    assert watcher.of(topic)[0] == 2.5
    row = watcher.wait_for(topic, lambda row: row.measured, "is measured")
    assert (row.publishers, row.subscribers, row.type_names) == (1, 0, (FLOAT,))
    assert row.published_by[0].reliability == reliability
    assert row.published_by[0].durability == durability
    peer.withdraw(topic)


def test_a_latched_value_of_long_ago_is_shown_and_is_not_called_quiet(
    peer: Peer, watcher: Watcher
) -> None:
    peer.advertise("/latched", type_name=STRING, durability="transient_local", depth=1)
    peer.publish("/latched", value={"data": "the map"})
    watcher.observer.watch(["/latched"])
    wait_until(lambda: watcher.of("/latched") == ["the map"], "the latched value")
    row = watcher.wait_for("/latched", lambda row: (row.age_s or 0) > 3.5, "is old")
    assert row.trouble is None


def test_the_last_value_is_shown_to_whoever_begins_to_look_later(
    peer: Peer, watcher: Watcher
) -> None:
    peer.advertise("/once", type_name=STRING)
    watcher.observer.measure(all_topics=True)
    wait_until(lambda: peer.listeners("/once"), "measured")
    peer.publish("/once", value={"data": "said once"})
    watcher.wait_for("/once", lambda row: row.count == 1, "is counted")
    assert watcher.of("/once") == []
    watcher.observer.watch(["/once"])
    wait_until(lambda: watcher.of("/once") == ["said once"], "the value from before")
    let_updates_come(watcher, 5)
    assert watcher.of("/once") == ["said once"]


def test_only_the_newest_is_decoded_of_a_watched_topic_and_all_of_a_followed_one(
    peer: Peer, watcher: Watcher
) -> None:
    for topic in ("/burst/watched", "/burst/followed"):
        peer.advertise(topic, type_name="std_msgs/msg/Int32", depth=200)
    watcher.observer.period_s = 0.5
    watcher.observer.watch(["/burst/watched"])
    watcher.observer.follow(["/burst/followed"])
    for topic in ("/burst/watched", "/burst/followed"):
        wait_until(partial(peer.listeners, topic), f"{topic} subscribed")
        peer.publish(topic, value={"data": "NUMBER"}, times=100)
    wait_until(lambda: watcher.of("/burst/followed")[-1:] == [99], "the last followed")
    wait_until(lambda: watcher.of("/burst/watched")[-1:] == [99], "the last watched")
    watcher.observer.period_s = 0.1
    assert watcher.of("/burst/followed") == list(range(100))
    assert len(watcher.of("/burst/watched")) < 10
    watcher.wait_for("/burst/watched", lambda row: row.count == 100, "all counted")


def test_bytes_arrive_as_bytes(peer: Peer, watcher: Watcher) -> None:
    peer.advertise("/mic", type_name="std_msgs/msg/ByteMultiArray", durability="transient_local")
    peer.publish("/mic", value={"data": [0, 27, 255]})
    watcher.observer.watch(["/mic"])
    wait_until(lambda: watcher.of("/mic"), "the sound")
    assert watcher.of("/mic")[0]["data"] == b"\x00\x1b\xff"


def test_a_topic_that_nobody_publishes_says_so(peer: Peer, watcher: Watcher) -> None:
    peer.listen("/unspoken", type_name=FLOAT)
    watcher.observer.watch(["/unspoken", "/not/there/at/all"])
    row = watcher.wait_for("/unspoken", lambda row: row.subscribers == 1, "a subscriber")
    assert row.trouble is Trouble.NO_PUBLISHER
    row = watcher.wait_for("/not/there/at/all", lambda _: True, "has a row")
    assert row.trouble is Trouble.NO_PUBLISHER
    assert row.type_names == ()


def test_the_first_words_of_a_new_publisher_are_heard(peer: Peer, watcher: Watcher) -> None:
    peer.listen("/first_words", type_name=STRING)
    watcher.observer.follow(["/first_words"])
    watcher.wait_for("/first_words", lambda row: row.measured, "is waited for")
    peer.advertise("/first_words", type_name=STRING)
    wait_until(lambda: peer.listeners("/first_words") == 2, "both matched")
    peer.publish("/first_words", value={"data": "hello"})
    wait_until(lambda: watcher.of("/first_words") == ["hello"], "the first word")


def test_a_quiet_publisher_is_told_from_a_missing_one(peer: Peer, watcher: Watcher) -> None:
    peer.advertise("/quiet", type_name=FLOAT)
    peer.repeat("/quiet", value={"data": 1.0}, hz=20)
    watcher.observer.watch(["/quiet"])
    watcher.wait_for("/quiet", lambda row: row.hz is not None, "has a rate")
    peer.silence("/quiet")
    row = watcher.wait_for("/quiet", lambda row: row.trouble is Trouble.QUIET, "is quiet")
    assert row.publishers == 1
    assert row.hz == 0.0
    assert float(row.facts["seconds"]) >= 3
    peer.repeat("/quiet", value={"data": 1.0}, hz=20)
    watcher.wait_for("/quiet", lambda row: row.trouble is None, "speaks again")
    again = pytest.approx(20, rel=0.3)
    watcher.wait_for("/quiet", lambda row: row.hz == again, "has its rate again")


def test_a_publisher_and_a_subscriber_that_do_not_fit_are_named(
    peer: Peer, watcher: Watcher
) -> None:
    peer.advertise("/misfit", type_name=FLOAT, reliability="best_effort")
    peer.listen("/misfit", type_name=FLOAT, reliability="reliable")
    peer.repeat("/misfit", value={"data": 1.0}, hz=20)
    watcher.observer.watch(["/misfit"])
    row = watcher.wait_for("/misfit", lambda row: row.trouble is Trouble.QOS_MISMATCH, "misfit")
    assert row.facts == {
        "policy": "reliability",
        "publisher": "/talker",
        "subscriber": "/talker",
        "offered": "best_effort",
        "requested": "reliable",
    }
    assert "Let /talker offer reliable, or let /talker ask for best_effort." in row.detail
    wait_until(lambda: watcher.of("/misfit"), "Deck itself hears it")


def test_a_type_that_is_not_installed_is_shown_as_such(
    peer: Peer, watcher: Watcher, monkeypatch: pytest.MonkeyPatch
) -> None:
    load_message.cache_clear()
    for module in [name for name in sys.modules if name.split(".")[0] == "nav_msgs"]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, "nav_msgs", None)
    peer.advertise("/strange", type_name="nav_msgs/msg/Odometry")
    peer.advertise("/known", type_name=FLOAT, durability="transient_local")
    peer.publish("/known", value={"data": 7.0})
    watcher.observer.watch(["/strange", "/known"])
    row = watcher.wait_for("/strange", lambda row: row.trouble is Trouble.UNKNOWN_TYPE, "unknown")
    assert row.facts["package"] == "nav_msgs"
    assert row.detail.startswith("package nav_msgs is not installed: 'apt install ros-jazzy-nav")
    assert row.facts["pip"] == row.facts["apt"] == row.facts["pixi"] == "ros-jazzy-nav-msgs"
    peer.repeat("/strange", value={}, hz=20)
    row = watcher.wait_for("/strange", lambda row: row.hz and abs(row.hz - 20) < 2, "its rate")
    assert row.bytes_per_s == pytest.approx(20 * CDR_OF_EMPTY_ODOMETRY, rel=0.2)
    assert row.trouble is Trouble.UNKNOWN_TYPE
    assert "/strange" not in watcher.samples
    wait_until(lambda: watcher.of("/known") == [7.0], "the other topic is not harmed")


def test_a_message_that_cannot_be_decoded_harms_nobody(peer: Peer, watcher: Watcher) -> None:
    peer.advertise("/garbage", type_name=STRING, durability="transient_local", depth=1)
    peer.publish_raw("/garbage", cdr="00010000ffffff7f41")
    watcher.observer.watch(["/garbage"])
    row = watcher.wait_for("/garbage", lambda row: row.trouble is Trouble.UNKNOWN_TYPE, "a trouble")
    assert "cannot be decoded" in row.detail
    peer.publish("/garbage", value={"data": "sense"})
    wait_until(lambda: watcher.of("/garbage") == ["sense"], "the next message")
    watcher.wait_for("/garbage", lambda row: row.trouble is None, "all is well")


def test_peers_that_disagree_about_the_type_are_remarked_on(
    peer: Peer, watcher: Watcher, module_domain: int
) -> None:
    other = Peer("other", module_domain)
    peer.advertise("/two_types", type_name=FLOAT)
    peer.repeat("/two_types", value={"data": 3.0}, hz=20)
    other.listen("/two_types", type_name=STRING)
    watcher.observer.watch(["/two_types"])
    row = watcher.wait_for("/two_types", lambda row: len(row.type_names) == 2, "two types")
    wait_until(lambda: watcher.of("/two_types"), "the published one is shown")
    assert watcher.of("/two_types")[-1] == 3.0
    assert row.facts == {"types": f"{FLOAT}, {STRING}", "shown": FLOAT}
    other.close()
    watcher.wait_for("/two_types", lambda row: row.type_names == (FLOAT,), "one type again")


def test_a_publisher_that_comes_back_with_another_qos_or_type_is_heard_again(
    peer: Peer, watcher: Watcher
) -> None:
    watcher.observer.watch(["/changing"])
    peer.advertise("/changing", type_name=FLOAT)
    peer.repeat("/changing", value={"data": 1.0}, hz=20)
    wait_until(lambda: watcher.of("/changing")[-1:] == [1.0], "the first")
    peer.withdraw("/changing")
    peer.advertise("/changing", type_name=FLOAT, reliability="best_effort")
    peer.repeat("/changing", value={"data": 2.0}, hz=20)
    wait_until(lambda: watcher.of("/changing")[-1:] == [2.0], "the best-effort one")
    peer.withdraw("/changing")
    peer.advertise("/changing", type_name=STRING)
    peer.repeat("/changing", value={"data": "three"}, hz=20)
    wait_until(lambda: watcher.of("/changing")[-1:] == ["three"], "the one of another type")


def test_the_lists_of_nodes_and_services_leave_out_deck_itself(
    peer: Peer, watcher: Watcher
) -> None:
    peer.serve("/add")
    watcher.observer.watch(["/kind"])
    wait_until(lambda: watcher.node("/talker"), "the node")
    wait_until(lambda: watcher.serves("/add"), "the service")
    service = next(row for row in watcher.update.services if row.name == "/add")
    assert service.type_names == ("example_interfaces/srv/AddTwoInts",)
    assert service.nodes == ("/talker",)
    assert all("deck_observer" not in row.name for row in watcher.update.nodes)
    assert all("deck_observer" not in row.name for row in watcher.update.services)
    assert [row.name for row in watcher.update.topics] == sorted(
        row.name for row in watcher.update.topics
    )


def test_a_topic_that_only_deck_publishes_has_no_publisher_to_be_shown(
    peer: Peer, watcher: Watcher
) -> None:
    peer.listen("/from_deck", type_name=STRING)
    watcher.observer.follow(["/from_deck"])
    watcher.wait_for("/from_deck", lambda row: row.measured, "is listened to")
    watcher.observer.publish("/from_deck", STRING, {"data": "x"}).result(20)
    wait_until(lambda: watcher.of("/from_deck") == ["x"], "Deck hears itself")
    row = watcher.wait_for("/from_deck", lambda row: row.trouble is None, "no trouble")
    assert (row.publishers, row.subscribers) == (0, 1)
    assert row.published_by == ()


def test_a_topic_that_deck_cannot_subscribe_says_so_and_harms_no_other(
    peer: Peer, watcher: Watcher
) -> None:
    """Fast DDS knows one type a topic in one process, and Deck publishes another one here."""
    watcher.observer.publish("/clash", STRING, {"data": "x"}).result(20)
    for topic in ("/clash", "/no_clash"):
        peer.advertise(topic, type_name=FLOAT)
        peer.repeat(topic, value={"data": 1.0}, hz=20)
    watcher.observer.watch(["/clash", "/no_clash"])
    row = watcher.wait_for(
        "/clash", lambda row: row.trouble is Trouble.UNKNOWN_TYPE, "cannot be subscribed"
    )
    assert f"/clash cannot be subscribed as {FLOAT}" in row.detail
    wait_until(lambda: watcher.of("/no_clash"), "the other topic")

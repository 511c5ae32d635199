"""Publishing at a rate: heard at that rate, ended when asked and with the observer."""

from __future__ import annotations

import time
from functools import partial
from typing import Any

import pytest
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Float32

from graph.data import Publication
from graph.messages.making import FieldError
from graph.messages.types import UnknownTypeError
from graph.observer.requests import ObserverError
from graph.publishing.outbox import PublishError
from tests.ros.observing import Peer as Process
from tests.ros.observing import Watcher
from tests.ros.peer import Peer
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

FLOAT = "std_msgs/msg/Float32"


def start(watcher: Watcher, topic: str, hz: float, value: float = 1.0) -> int:
    return watcher.observer.start_publishing(topic, FLOAT, {"data": value}, hz).result(30)


def row(watcher: Watcher, number: int) -> Publication | None:
    return next((each for each in watcher.update.publications if each.number == number), None)


@pytest.mark.parametrize("hz", [20.0, 100.0])
def test_it_is_heard_at_its_rate(watcher: Watcher, peer: Peer, hz: float) -> None:
    arrivals: list[float] = []
    peer.node.create_subscription(Float32, "/out", lambda _: arrivals.append(time.monotonic()), 500)
    start(watcher, "/out", hz)
    count = int(2 * hz)
    wait_until(lambda: len(arrivals) > count, f"{count} messages")
    assert arrivals[count] - arrivals[0] == pytest.approx(2.0, abs=0.4)


def test_updates_tell_of_it_until_it_is_stopped(watcher: Watcher, peer: Peer) -> None:
    heard = peer.hear("/out", Float32)
    number = start(watcher, "/out", 50.0, 2.5)

    def told() -> Publication | None:
        found = row(watcher, number)
        return found if found and found.sent > 5 and found.subscribers == 1 else None

    found = wait_until(told, "a row")
    assert found == Publication(number, "/out", FLOAT, 50.0, found.sent, 1)
    wait_until(lambda: heard, "a message")
    assert heard[0].data == 2.5
    topic = watcher.wait_for("/out", lambda topic: topic.own_publishers, "shows Deck")
    assert topic.publishers == 0
    watcher.observer.stop_publishing(number)
    wait_until(lambda: not watcher.update.publications, "no row")
    # Deck's publisher has left the graph, so nothing more can come.
    wait_until(lambda: not peer.node.count_publishers("/out"), "no publisher")


@pytest.mark.parametrize("echo_first", [False, True])
def test_decks_own_echo_is_no_listener(watcher: Watcher, peer: Peer, echo_first: bool) -> None:
    peer.hear("/out", Float32)
    if echo_first:
        watcher.observer.watch(["/out"])
        watcher.wait_for("/out", lambda topic: topic.measured, "is subscribed to")
    number = start(watcher, "/out", 50.0)
    watcher.observer.watch(["/out"])
    wait_until(lambda: watcher.of("/out"), "the echo")
    wait_until(lambda: (found := row(watcher, number)) and found.subscribers == 1, "the peer")


def is_silent(peer: Peer, topic: str) -> bool:
    return not peer.node.count_publishers(topic)


def test_all_are_stopped_even_one_that_has_not_begun(watcher: Watcher, peer: Peer) -> None:
    start(watcher, "/one", 50.0)
    waiting = watcher.observer.start_publishing("/other", FLOAT, {"data": 1.0}, 50.0)
    watcher.observer.stop_publishing_all()
    waiting.result(30)
    wait_until(lambda: not watcher.update.publications, "no row")
    for topic in ("/one", "/other"):
        wait_until(partial(is_silent, peer, topic), "no publisher")
    number = start(watcher, "/one", 50.0)
    wait_until(lambda: row(watcher, number), "a new one")


def test_several_at_once_hold_each_their_own_rate(watcher: Watcher, peer: Peer) -> None:
    slow, quick = peer.hear("/slow", Float32, 500), peer.hear("/quick", Float32, 500)
    start(watcher, "/slow", 5.0)
    start(watcher, "/quick", 50.0)
    wait_until(lambda: slow and quick, "both are heard")
    slow.clear()
    quick.clear()
    wait_until(lambda: len(slow) >= 10, "ten of the slow one")
    assert 80 <= len(quick) <= 120


def test_the_first_message_of_a_slow_one_goes_out_at_once(watcher: Watcher) -> None:
    number = start(watcher, "/out", 0.1)
    wait_until(lambda: (found := row(watcher, number)) and found.sent == 1, "one sent", 9.0)


def test_it_ends_with_the_observer(ros_domain: int, peer: Peer) -> None:
    watcher = Watcher(ros_domain)
    heard = peer.hear("/out", Float32)
    start(watcher, "/out", 50.0)
    wait_until(lambda: heard, "a message")
    watcher.close()
    wait_until(lambda: not peer.node.count_publishers("/out"), "no publisher")


def test_a_latched_listener_that_comes_later_hears_it_too(watcher: Watcher, peer: Peer) -> None:
    number = start(watcher, "/out", 10.0)
    latched = QoSProfile(
        depth=1,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
        reliability=ReliabilityPolicy.RELIABLE,
    )
    heard = peer.hear("/out", Float32, latched)
    wait_until(lambda: len(heard) > 3, "messages")
    assert row(watcher, number)


@pytest.mark.parametrize("hz", [0.0, 0.05, 100.5, -1.0, float("nan"), float("inf"), True])
def test_a_rate_that_is_none_is_refused(watcher: Watcher, hz: float) -> None:
    with pytest.raises(PublishError, match=r"the rate must be between 0\.1 and 100 Hz, not "):
        start(watcher, "/out", hz)


@pytest.mark.parametrize(
    ("topic", "type_name", "value", "kind", "words"),
    [
        ("/out", FLOAT, {"daat": 1}, FieldError, "daat: no such field; did you mean data"),
        ("/out", FLOAT, {"data": "x"}, FieldError, "data: expected a number, got 'x'"),
        ("/out", "foo_msgs/msg/Bar", {}, UnknownTypeError, "foo_msgs is not installed"),
        ("/a name", FLOAT, {}, PublishError, "/a name cannot be published"),
        ("/typed", FLOAT, {}, PublishError, "/typed carries std_msgs/msg/Bool, not std_msgs/msg/F"),
    ],
)
def test_what_cannot_be_published_is_refused_in_words(
    watcher: Watcher,
    ros_domain: int,
    topic: str,
    type_name: str,
    value: dict[str, Any],
    kind: type[Exception],
    words: str,
) -> None:
    other = None
    if topic == "/typed":
        other = Process("other", ros_domain)
        other.advertise("/typed", type_name="std_msgs/msg/Bool")
        wait_until(lambda: watcher.row("/typed"), "the topic")
    with pytest.raises(kind, match=words):
        watcher.observer.start_publishing(topic, type_name, value, 10.0).result(30)
    assert watcher.update.publications == ()
    if other:
        other.close()


def test_an_observer_that_has_stopped_refuses(ros_domain: int) -> None:
    watcher = Watcher(ros_domain)
    watcher.close()
    with pytest.raises(ObserverError):
        start(watcher, "/out", 1.0)
    watcher.observer.stop_publishing(1)

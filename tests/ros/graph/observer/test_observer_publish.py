"""Publishing once: nothing is lost, latched messages stay, and what does not fit is said."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest

import graph.ros
from graph.messages.making import FieldError
from graph.messages.types import UnknownTypeError
from graph.observer.observer import Observer
from graph.observer.requests import ObserverError
from graph.publishing.outbox import PublishError
from tests.ros.observing import Peer, Watcher
from tests.waiting import wait_until

STRING = "std_msgs/msg/String"
BOOL = "std_msgs/msg/Bool"


@pytest.fixture(scope="module")
def peer(module_domain: int) -> Iterator[Peer]:
    peer = Peer("listener", module_domain)
    yield peer
    peer.close()


@pytest.fixture(scope="module")
def watcher(module_domain: int) -> Iterator[Watcher]:
    watcher = Watcher(module_domain)
    yield watcher
    watcher.close()


def known(watcher: Watcher, topic: str) -> None:
    """Wait until the observer has found the topic."""
    watcher.wait_for(topic, lambda row: row.subscribers, "has a subscriber")


def test_the_very_first_message_reaches_its_subscriber(peer: Peer, watcher: Watcher) -> None:
    peer.listen("/first", type_name=STRING)
    known(watcher, "/first")
    assert watcher.observer.publish("/first", STRING, {"data": "вперед"}).result(10) == 1
    wait_until(lambda: peer.heard.get("/first") == ["вперед"], "the message")


def test_who_hears_it_is_counted_without_the_echo(peer: Peer, watcher: Watcher) -> None:
    heard = {"/echoed": 1, "/echoed/unheard": 0}
    peer.listen("/echoed", type_name=STRING)
    peer.advertise("/echoed/unheard", type_name=STRING)
    known(watcher, "/echoed")
    watcher.wait_for("/echoed/unheard", lambda row: row.publishers, "has a publisher")
    counts: list[dict[str, int]] = []

    def has_echo() -> bool:
        futures = {topic: watcher.observer.publish(topic, STRING, {"data": "x"}) for topic in heard}
        counts.append({topic: future.result(10) for topic, future in futures.items()})
        return all(watcher.of(topic) for topic in heard)

    try:
        # The echo is opened while the publishers are there, and counted at no moment.
        assert not has_echo()
        watcher.observer.watch(heard)
        wait_until(has_echo, "an echo of both")
        assert counts == [heard] * len(counts)
    finally:
        watcher.observer.watch(())


def test_messages_keep_their_order(peer: Peer, watcher: Watcher) -> None:
    peer.listen("/order", type_name=STRING, depth=100)
    known(watcher, "/order")
    futures = [watcher.observer.publish("/order", STRING, {"data": str(n)}) for n in range(50)]
    assert all(future.result(10) == 1 for future in futures)
    wait_until(lambda: len(peer.heard.get("/order", [])) == 50, "all messages")
    assert peer.heard["/order"] == [str(n) for n in range(50)]


@pytest.mark.parametrize("reliability", ["reliable", "best_effort"])
@pytest.mark.parametrize("durability", ["volatile", "transient_local"])
def test_every_kind_of_subscriber_hears_it(
    peer: Peer, watcher: Watcher, reliability: str, durability: str
) -> None:
    topic = f"/to/{reliability}/{durability}"
    peer.listen(topic, type_name=STRING, reliability=reliability, durability=durability)
    known(watcher, topic)
    assert watcher.observer.publish(topic, STRING, {"data": "x"}).result(10) == 1
    wait_until(lambda: peer.heard.get(topic) == ["x"], "the message")


def test_a_latched_message_reaches_those_who_come_later(peer: Peer, watcher: Watcher) -> None:
    future = watcher.observer.publish("/emergency_stop", BOOL, {"data": True}, latched=True)
    assert future.result(10) == 0
    peer.listen("/emergency_stop", type_name=BOOL, durability="transient_local", depth=1)
    wait_until(lambda: peer.heard.get("/emergency_stop") == ["True"], "the stop of before")
    watcher.observer.publish("/emergency_stop", BOOL, {"data": False}, latched=True)
    wait_until(lambda: peer.heard["/emergency_stop"] == ["True", "False"], "the release")


def test_a_prepared_publisher_needs_no_time_to_find_its_subscribers(
    peer: Peer, watcher: Watcher
) -> None:
    peer.listen("/prepared", type_name=BOOL, durability="transient_local", depth=1)
    watcher.observer.prepare_publisher("/prepared", BOOL, latched=True).result(10)
    wait_until(lambda: "/listener" in peer.names(), "the graph")
    known(watcher, "/prepared")
    watcher.observer.publish("/prepared", BOOL, {"data": False}, latched=True).result(10)

    def at_once() -> bool:
        began_s = time.monotonic()
        watcher.observer.publish("/prepared", BOOL, {"data": True}, latched=True).result(10)
        return time.monotonic() - began_s < 0.05

    # Not a benchmark: a wait for the next look of 0.1 s, or for a match, would show in every one.
    wait_until(at_once, "a message that waits for nothing", every_s=0.0)


def test_nobody_listening_is_told_by_a_zero(watcher: Watcher) -> None:
    assert watcher.observer.publish("/to_nobody", STRING, {"data": "x"}).result(10) == 0


@pytest.mark.parametrize(
    ("topic", "type_name", "value", "error", "word"),
    [
        ("/typed", STRING, {"data": "x"}, PublishError, "/typed carries std_msgs/msg/Bool"),
        ("/new", "foo_msgs/msg/Bar", {}, UnknownTypeError, "foo_msgs is not installed"),
        ("/new", STRING, {"data": 5}, FieldError, "data: expected a string, got 5"),
        ("/new", STRING, {"dat": "x"}, FieldError, "dat: no such field; did you mean data?"),
        ("/9 lives", STRING, {"data": "x"}, PublishError, "/9 lives cannot be published"),
    ],
)
def test_what_cannot_be_published_is_refused_in_words(
    peer: Peer,
    watcher: Watcher,
    topic: str,
    type_name: str,
    value: dict[str, Any],
    error: type[Exception],
    word: str,
) -> None:
    if watcher.row("/typed") is None:
        peer.listen("/typed", type_name=BOOL)
        known(watcher, "/typed")
    with pytest.raises(error, match=word.replace("?", r"\?")):
        watcher.observer.publish(topic, type_name, value).result(10)


def test_what_is_asked_for_before_the_start_is_done_after_it(
    peer: Peer, module_domain: int
) -> None:
    peer.listen("/early", type_name=STRING, durability="transient_local", depth=1)
    observer = Observer(module_domain)
    future = observer.publish("/early", STRING, {"data": "early"}, latched=True)
    assert not future.done()
    observer.start(lambda _: None)
    try:
        future.result(30)
        wait_until(lambda: peer.heard.get("/early") == ["early"], "the message")
    finally:
        observer.stop()
    with pytest.raises(ObserverError, match="stopped"):
        observer.publish("/early", STRING, {"data": "late"}).result(1)


def test_one_that_was_taken_back_in_time_is_not_published(peer: Peer, module_domain: int) -> None:
    peer.listen("/taken_back", type_name=STRING)
    observer = Observer(module_domain)
    taken_back = observer.publish("/taken_back", STRING, {"data": "no"})
    assert taken_back.cancel()
    kept = observer.publish("/taken_back", STRING, {"data": "yes"})
    observer.start(lambda _: None)
    try:
        assert kept.result(30) == 1
        wait_until(lambda: peer.heard.get("/taken_back"), "the other")
        assert peer.heard["/taken_back"] == ["yes"]
    finally:
        observer.stop()


def test_last_words_reach_a_node_that_is_held_up(
    ros_domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They may be a stop; who leaves at once takes them along."""
    monkeypatch.setattr(graph.ros, "ACKED_WITHIN_S", 30.0)
    listeners = [Peer(f"n{number}", ros_domain) for number in range(5)]
    watcher = Watcher(ros_domain)
    try:
        for one in listeners:
            one.listen("/last", type_name=STRING)
        watcher.wait_for("/last", lambda row: row.subscribers == len(listeners), "subscribers")
        watcher.observer.publish("/last", STRING, {"data": "go"}).result(10)
        for one in listeners:
            wait_until(lambda: one.heard.get("/last"), one.name)  # noqa: B023
            one.process.send_signal(signal.SIGSTOP)
        awake = threading.Timer(0.5, _wake, [listeners])
        awake.start()
        watcher.observer.publish("/last", STRING, {"data": "stop"}).result(10)
        watcher.close()
        awake.join()
        for one in listeners:
            wait_until(lambda: one.heard["/last"] == ["go", "stop"], one.name)  # noqa: B023
    finally:
        _wake(listeners)
        watcher.close()
        for one in listeners:
            one.close()


def _wake(listeners: list[Peer]) -> None:
    for one in listeners:
        one.process.send_signal(signal.SIGCONT)

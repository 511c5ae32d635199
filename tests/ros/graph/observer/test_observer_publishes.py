"""Publishing: once, at a rate, and held; nothing is lost, and all that commands ends in time."""

from __future__ import annotations

import signal
import threading
import time
from functools import partial
from typing import Any

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from std_msgs.msg import Float32

import graph.ros
from graph.data import Publication
from graph.messages.making import FieldError
from graph.messages.types import UnknownTypeError
from graph.observer.requests import Hold, PrepareHold, Publish, StartPublishing, StopCommanding, StopPublishingAll
from graph.publishing.dead_man_switch import RESTS, HeldCommand
from graph.publishing.outbox import PublishError
from tests.ros.observing import Peer, Watcher
from tests.ros.peer import Peer as InProcess
from tests.waiting import wait_until

STRING = "std_msgs/msg/String"
BOOL = "std_msgs/msg/Bool"
FLOAT = "std_msgs/msg/Float32"
HELD_S = 1.0
DRIVE = "ackermann_msgs/msg/AckermannDriveStamped"


def known(watcher: Watcher, topic: str) -> None:
    """Wait until the observer has found the topic."""
    watcher.wait_for(topic, lambda row: row.subscribers, "has a subscriber")


def test_the_very_first_message_reaches_its_subscriber(talker: Peer, watcher: Watcher) -> None:
    talker.listen("/first", type_name=STRING)
    known(watcher, "/first")
    assert watcher.observer.ask(Publish("/first", STRING, {"data": "вперед"})).result(10) == 1
    wait_until(lambda: talker.heard.get("/first") == ["вперед"], "the message")


def test_who_hears_it_is_counted_without_the_echo(talker: Peer, watcher: Watcher) -> None:
    heard = {"/echoed": 1, "/echoed/unheard": 0}
    talker.listen("/echoed", type_name=STRING)
    talker.advertise("/echoed/unheard", type_name=STRING)
    known(watcher, "/echoed")
    watcher.wait_for("/echoed/unheard", lambda row: row.publishers, "has a publisher")
    counts: list[dict[str, int]] = []

    def has_echo() -> bool:
        futures = {topic: watcher.observer.ask(Publish(topic, STRING, {"data": "x"})) for topic in heard}
        counts.append({topic: future.result(10) for topic, future in futures.items()})
        return all(watcher.of(topic) for topic in heard)

    try:
        # The echo is opened while the publishers are there, and counted at no moment.
        assert not has_echo()
        watcher.want(watched=heard)
        wait_until(has_echo, "an echo of both")
        assert counts == [heard] * len(counts)
    finally:
        watcher.want(watched=())


@pytest.mark.parametrize("reliability", ["reliable", "best_effort"])
@pytest.mark.parametrize("durability", ["volatile", "transient_local"])
def test_every_kind_of_subscriber_hears_it(talker: Peer, watcher: Watcher, reliability: str, durability: str) -> None:
    topic = f"/to/{reliability}/{durability}"
    talker.listen(topic, type_name=STRING, reliability=reliability, durability=durability)
    known(watcher, topic)
    assert watcher.observer.ask(Publish(topic, STRING, {"data": "x"})).result(10) == 1
    wait_until(lambda: talker.heard.get(topic) == ["x"], "the message")


def test_a_latched_message_reaches_those_who_come_later(talker: Peer, watcher: Watcher) -> None:
    future = watcher.observer.ask(Publish("/emergency_stop", BOOL, {"data": True}, latched=True))
    assert future.result(10) == 0
    talker.listen("/emergency_stop", type_name=BOOL, durability="transient_local", depth=1)
    wait_until(lambda: talker.heard.get("/emergency_stop") == ["True"], "the stop of before")
    watcher.observer.ask(Publish("/emergency_stop", BOOL, {"data": False}, latched=True))
    wait_until(lambda: talker.heard["/emergency_stop"] == ["True", "False"], "the release")


def test_what_cannot_be_published_is_refused_in_words(talker: Peer, watcher: Watcher) -> None:
    talker.listen("/typed", type_name=BOOL)
    known(watcher, "/typed")
    for topic, type_name, value, error, word in (
        ("/typed", STRING, {"data": "x"}, PublishError, "/typed carries std_msgs/msg/Bool"),
        ("/new", "foo_msgs/msg/Bar", {}, UnknownTypeError, "foo_msgs is not installed"),
        ("/new", STRING, {"data": 5}, FieldError, "data: expected a string, got 5"),
        ("/9 lives", STRING, {"data": "x"}, PublishError, "/9 lives cannot be published"),
    ):
        with pytest.raises(error, match=word):
            watcher.observer.ask(Publish(topic, type_name, value)).result(10)


def test_last_words_reach_a_node_that_is_held_up(ros_domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """They may be a stop; who leaves at once takes them along."""
    monkeypatch.setattr(graph.ros, "ACKED_WITHIN_S", 30.0)
    listeners = [Peer(f"n{number}", ros_domain) for number in range(5)]
    watcher = Watcher(ros_domain)
    try:
        for one in listeners:
            one.listen("/last", type_name=STRING)
        watcher.wait_for("/last", lambda row: row.subscribers == len(listeners), "subscribers")
        watcher.observer.ask(Publish("/last", STRING, {"data": "go"})).result(10)
        for one in listeners:
            wait_until(lambda: one.heard.get("/last"), one.name)  # noqa: B023
            one.process.send_signal(signal.SIGSTOP)
        awake = threading.Timer(0.5, _wake, [listeners])
        awake.start()
        watcher.observer.ask(Publish("/last", STRING, {"data": "stop"})).result(10)
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


# ---------------------------------------------------------------- at a rate


def start(watcher: Watcher, topic: str, hz: float, value: float = 1.0) -> int:
    return watcher.observer.ask(StartPublishing(topic, FLOAT, {"data": value}, hz)).result(30)


def row(watcher: Watcher, number: int) -> Publication | None:
    return next((each for each in watcher.update.publications if each.number == number), None)


def test_it_is_heard_at_its_rate(watcher: Watcher, peer: InProcess) -> None:
    hz, arrivals = 50.0, list[float]()
    peer.node.create_subscription(Float32, "/out", lambda _: arrivals.append(time.monotonic()), 500)
    start(watcher, "/out", hz)
    count = int(2 * hz)
    wait_until(lambda: len(arrivals) > count, f"{count} messages")
    assert arrivals[count] - arrivals[0] == pytest.approx(2.0, abs=0.4)


def is_silent(peer: InProcess, topic: str) -> bool:
    return not peer.node.count_publishers(topic)


def test_all_are_stopped_even_one_that_has_not_begun(watcher: Watcher, peer: InProcess) -> None:
    start(watcher, "/one", 50.0)
    waiting = watcher.observer.ask(StartPublishing("/other", FLOAT, {"data": 1.0}, 50.0))
    watcher.observer.ask(StopPublishingAll())
    waiting.result(30)
    wait_until(lambda: not watcher.update.publications, "no row")
    for topic in ("/one", "/other"):
        wait_until(partial(is_silent, peer, topic), "no publisher")
    number = start(watcher, "/one", 50.0)
    wait_until(lambda: row(watcher, number), "a new one")


# ---------------------------------------------------------------- held


def command(speed: float, for_s: float, hz: float = 20.0) -> HeldCommand:
    return HeldCommand({"drive": {"speed": speed}}, {}, hz, time.monotonic() + for_s)


def ready(watcher: Watcher, peer: InProcess) -> list[tuple[float, float]]:
    """Have a robot listen and a publisher made for it; return (time, speed) of what it hears."""
    heard: list[tuple[float, float]] = []

    def hear(message: Any) -> None:
        assert message.header.stamp.sec > 0
        heard.append((time.monotonic(), message.drive.speed))

    peer.node.create_subscription(AckermannDriveStamped, "/drive", hear, 100)
    watcher.wait_for("/drive", lambda row: row.subscribers == 1, "the robot listens")
    watcher.observer.ask(PrepareHold("/drive", DRIVE)).result(30)
    wait_until(lambda: peer.node.count_publishers("/drive"), "the publisher is found")
    return heard


def test_it_is_repeated_while_it_is_held_and_rests_when_nobody_says_more(watcher: Watcher, peer: InProcess) -> None:
    heard = ready(watcher, peer)
    began_s = time.monotonic()
    asked_s = began_s
    while asked_s - began_s < 1.0:
        asked_s = time.monotonic()
        watcher.observer.ask(Hold("/drive", DRIVE, command(0.2, HELD_S))).result(30)
    # From here on nobody says anything: as if whoever held it had hung.
    let_go_s = time.monotonic()
    wait_until(lambda: len([1 for _at, speed in heard if speed == 0]) == RESTS, "rest")
    moving = [at for at, speed in heard if speed]
    # Twenty a second, fewer on a busy machine.
    assert 8 <= len(moving) <= 20 * (1.0 + HELD_S) + 8
    resting = [at for at, speed in heard if not speed]
    assert asked_s + HELD_S < resting[0] < let_go_s + HELD_S + 1.75
    assert moving[-1] < resting[0]


def test_an_observer_that_ends_rests_with_its_last_word(module_domain: int, peer: InProcess) -> None:
    watcher = Watcher(module_domain)
    heard = ready(watcher, peer)
    watcher.observer.ask(Hold("/drive", DRIVE, command(0.2, 2.0))).result(30)
    wait_until(lambda: heard, "it moves")
    watcher.close()
    wait_until(lambda: heard[-1][1] == 0, "rest")


def test_all_that_commands_stops_at_once_and_the_observer_goes_on(watcher: Watcher, peer: InProcess) -> None:
    heard, numbers = ready(watcher, peer), peer.hear("/out", Float32)
    watcher.observer.ask(StartPublishing("/out", "std_msgs/msg/Float32", {"data": 1.0}, 50.0)).result(30)
    watcher.observer.ask(Hold("/drive", DRIVE, command(0.2, 30.0))).result(30)
    wait_until(lambda: heard and numbers, "both are heard")
    watcher.observer.ask(StopCommanding())
    wait_until(lambda: heard[-1][1] == 0, "rest")
    wait_until(lambda: not peer.node.count_publishers("/out"), "no publisher")
    watcher.observer.ask(Hold("/drive", DRIVE, command(0.3, 0.25))).result(30)
    wait_until(lambda: heard[-1][1] > 0.25, "it can be driven again")

"""What is held on the observer's thread: it moves while it is held, and rests by itself."""

from __future__ import annotations

import time
from typing import Any

import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from std_msgs.msg import Float32

from graph.messages.making import FieldError
from graph.publishing.dead_man_switch import RESTS, HeldCommand
from graph.publishing.outbox import PublishError
from tests.ros.observing import Watcher
from tests.ros.peer import Peer
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

HELD_S = 1.0
DRIVE = "ackermann_msgs/msg/AckermannDriveStamped"


def command(speed: float, for_s: float, hz: float = 20.0) -> HeldCommand:
    return HeldCommand({"drive": {"speed": speed}}, {}, hz, time.monotonic() + for_s)


def ready(watcher: Watcher, peer: Peer) -> list[tuple[float, float]]:
    """Have a robot listen and a publisher made for it; return (time, speed) of what it hears."""
    heard: list[tuple[float, float]] = []

    def hear(message: Any) -> None:
        assert message.header.stamp.sec > 0
        heard.append((time.monotonic(), message.drive.speed))

    peer.node.create_subscription(AckermannDriveStamped, "/drive", hear, 100)
    watcher.wait_for("/drive", lambda row: row.subscribers == 1, "the robot listens")
    watcher.observer.prepare_hold("/drive", DRIVE).result(30)
    wait_until(lambda: peer.node.count_publishers("/drive"), "the publisher is found")
    return heard


def test_it_is_repeated_while_it_is_held_and_rests_when_nobody_says_more(
    watcher: Watcher, peer: Peer
) -> None:
    heard = ready(watcher, peer)
    began_s = time.monotonic()
    asked_s = began_s
    while asked_s - began_s < 1.0:
        asked_s = time.monotonic()
        watcher.observer.hold("/drive", DRIVE, command(0.2, HELD_S)).result(30)
    # From here on nobody says anything: as if whoever held it had hung.
    let_go_s = time.monotonic()
    wait_until(lambda: len([1 for _at, speed in heard if speed == 0]) == RESTS, "rest")
    moving = [at for at, speed in heard if speed]
    # Twenty a second, fewer on a busy machine.
    assert 8 <= len(moving) <= 20 * (1.0 + HELD_S) + 8
    resting = [at for at, speed in heard if not speed]
    assert asked_s + HELD_S < resting[0] < let_go_s + HELD_S + 1.75
    assert moving[-1] < resting[0]


def test_nothing_goes_out_until_something_is_held(watcher: Watcher, peer: Peer) -> None:
    heard = ready(watcher, peer)
    watcher.observer.hold("/drive", DRIVE, command(0.2, -1.0)).result(30)
    watcher.observer.let_go("/drive")
    watcher.observer.hold("/drive", DRIVE, command(0.3, 30.0)).result(30)
    watcher.observer.let_go("/drive")
    wait_until(lambda: len(heard) >= 2, "a command and rest")
    assert [round(speed, 3) for _at, speed in heard[:2]] == [0.3, 0.0]


def test_an_observer_that_ends_rests_with_its_last_word(watcher: Watcher, peer: Peer) -> None:
    heard = ready(watcher, peer)
    watcher.observer.hold("/drive", DRIVE, command(0.2, 2.0)).result(30)
    wait_until(lambda: heard, "it moves")
    watcher.observer.stop()
    wait_until(lambda: heard[-1][1] == 0, "rest")


def test_all_that_commands_stops_at_once_and_the_observer_goes_on(
    watcher: Watcher, peer: Peer
) -> None:
    heard, numbers = ready(watcher, peer), peer.hear("/out", Float32)
    watcher.observer.start_publishing("/out", "std_msgs/msg/Float32", {"data": 1.0}, 50.0).result(
        30
    )
    watcher.observer.hold("/drive", DRIVE, command(0.2, 30.0)).result(30)
    wait_until(lambda: heard and numbers, "both are heard")
    watcher.observer.stop_commanding()
    wait_until(lambda: heard[-1][1] == 0, "rest")
    wait_until(lambda: not peer.node.count_publishers("/out"), "no publisher")
    watcher.observer.hold("/drive", DRIVE, command(0.3, 0.25)).result(30)
    wait_until(lambda: heard[-1][1] > 0.25, "it can be driven again")


def test_what_cannot_be_held_says_why(watcher: Watcher, peer: Peer) -> None:
    ready(watcher, peer)
    wrong = HeldCommand({"drive": {"speedy": 1.0}}, {}, 20.0, time.monotonic() + 1.0)
    with pytest.raises(FieldError, match="speedy"):
        watcher.observer.hold("/drive", DRIVE, wrong).result(30)
    peer.hear("/other", Float32)
    watcher.wait_for("/other", lambda row: row.subscribers == 1, "another type")
    with pytest.raises(PublishError, match="carries std_msgs"):
        watcher.observer.prepare_hold("/other", DRIVE).result(30)

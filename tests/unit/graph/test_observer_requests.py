"""What cannot wait: a stop is published in the middle of a look at the graph, the rest is not."""

from __future__ import annotations

import time
from concurrent.futures import Future
from typing import Any, cast

import pytest

from graph.data import GraphUpdate
from graph.observer.loop import ObserverLoop
from graph.observer.node import ObserverNode
from graph.observer.requests import ObserverError
from graph.observer.settings import ObserverSettings
from graph.publishing.dead_man_switch import HeldCommand
from text.i18n import localized
from text.sentences import say

BOOL, STOP = "std_msgs/msg/Bool", {"data": True}


class Desk:
    """As much of the observer's node as these requests touch; it notes what was done."""

    def __init__(self, *known: str) -> None:
        self.known = set(known)
        self.done: list[str] = []
        self.outbox = self.dead_man_switch = self

    def knows_latched(self, topic: str, _type_name: str) -> bool:
        return topic in self.known

    def knows(self, topic: str) -> bool:
        return topic in self.known

    def ends(self, topic: str) -> None:
        self.done.append(f"look for {topic}")

    def prepare(self, topic: str, _type_name: str, _ends: None) -> None:
        self.known.add(topic)

    def publish(
        self,
        topic: str,
        _type: str,
        _value: Any,
        _ends: None,
        future: Future[int],
        *,
        latched: bool,
    ) -> None:
        self.done.append(f"publish {topic} {latched}")
        future.set_result(1)

    def hold(self, topic: str, _command: HeldCommand) -> int:
        self.done.append(f"hold {topic}")
        return 1

    def let_go(self, topic: str) -> None:
        self.done.append(f"let go of {topic}")

    def step(self) -> None:
        self.done.append("step")


def command() -> HeldCommand:
    return HeldCommand({}, {}, 20.0, time.monotonic() + 1.0)


class Nobody:
    """Nobody gives orders while these requests are carried out."""

    def tell(self, update: GraphUpdate) -> None:
        raise AssertionError(update)

    def wait(self, within_s: float) -> None:
        raise AssertionError(within_s)

    def look(self) -> bool:
        return False


def a_loop() -> ObserverLoop:
    return ObserverLoop(ObserverSettings(1), Nobody())


def test_what_cannot_wait_is_done_in_the_middle_of_a_look() -> None:
    loop, desk = a_loop(), Desk("/stop", "/drive")
    node = cast("ObserverNode", desk)
    chatter = loop.orders.publish("/chatter", BOOL, STOP, False)
    held = loop.orders.hold("/drive", BOOL, command())
    stop = loop.orders.publish("/stop", BOOL, STOP, True)
    loop.orders.let_go("/drive")
    loop.serve_urgent(node)
    assert desk.done == ["hold /drive", "publish /stop True", "let go of /drive", "step"]
    assert stop.done()
    assert held.done()
    assert not chatter.done()
    loop._requests.carry_out(node)
    assert desk.done[4:] == ["look for /chatter", "publish /chatter False"]


def test_what_needs_a_look_itself_waits_for_the_end_of_this_one() -> None:
    loop, desk = a_loop(), Desk()
    node = cast("ObserverNode", desk)
    loop.orders.hold("/drive", BOOL, command())
    loop.orders.publish("/stop", BOOL, STOP, True)
    loop.serve_urgent(node)
    assert desk.done == ["step"]
    loop._requests.carry_out(node)
    assert desk.done[1:] == [
        "look for /drive",
        "hold /drive",
        "look for /stop",
        "publish /stop True",
    ]


def test_what_cannot_be_done_any_more_says_so() -> None:
    loop = a_loop()
    before = loop.orders.publish("/stop", BOOL, STOP, True)
    loop._requests.refuse(ObserverError("over"))
    for future in (before, loop.orders.publish("/stop", BOOL, STOP, True)):
        with pytest.raises(ObserverError, match="over"):
            future.result(0)


def test_why_ros_cannot_be_used_is_told_so_that_it_can_be_translated() -> None:
    loop = a_loop()
    loop._requests.refuse(ObserverError(say("ROS cannot be used: {error}", error="no rclpy")))
    reasons = (
        loop.orders.parameters("/node", 1.0).result(0).error,
        loop.orders.set_parameters("/node", {}, 1.0).result(0).error,
        loop.orders.call("/service", "std_srvs/srv/Empty", {}, 1.0).result(0).error,
    )
    for reason in reasons:
        assert localized(reason, "ru") == "ROS не работает: no rclpy"

"""Requests to the graph: calls, goals, states, publishing at a rate, and at rest in time."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Mapping
from concurrent.futures import Future
from multiprocessing import Pipe
from types import SimpleNamespace
from typing import Any, cast

import pytest
from deck_interfaces.action import DriveToPoint
from hypothesis import given
from hypothesis import strategies as st

from graph.calls import goals as goals_life
from graph.calls.action_client import GoalAnswers
from graph.calls.exchanges import Exchange, NodeRequest, read_level
from graph.calls.goals import GoalLife
from graph.calls.lifecycle import CHANGE_WITHIN_S, ChangeFacts, change, managed
from graph.data import ANSWER_WITHIN_S, Goal, GoalStatus, ServiceRow, Value
from graph.messages.making import Draft
from graph.observer.node import ObserverNode
from graph.observer.process import ObserverLoop
from graph.observer.requests import Hold, LetGo, Order, Publish, Request, StartPublishing, StopPublishingAll
from graph.publishing.dead_man_switch import CommandRepeater, HeldCommand
from graph.publishing.outbox import LATE_S, _Repeated
from graph.qos import RELIABLE, VOLATILE, Qos

BOOL, STOP = "std_msgs/msg/Bool", {"data": True}


class Desk:
    """As much of the observer's node as these requests touch; it notes what was done."""

    def __init__(self, *known: str) -> None:
        self.known = set(known)
        self.done: list[str] = []
        self.outbox = self.dead_man_switch = self.publications = self

    def knows_latched(self, topic: str, _type_name: str) -> bool:
        return topic in self.known

    def knows(self, topic: str) -> bool:
        return topic in self.known

    def ends(self, topic: str) -> None:
        self.done.append(f"look for {topic}")

    def prepare(self, topic: str, _type_name: str, _ends: None) -> None:
        self.known.add(topic)

    def publish(
        self, topic: str, _type: str, _value: Any, _ends: None, future: Future[int], *, latched: bool
    ) -> None:
        self.done.append(f"publish {topic} {latched}")
        future.set_result(1)

    def hold(self, topic: str, _command: HeldCommand) -> int:
        self.done.append(f"hold {topic}")
        return 1

    def let_go(self, topic: str) -> None:
        self.done.append(f"let go of {topic}")

    def start(self, topic: str, *_rest: Any) -> int:
        self.done.append(f"start {topic}")
        return 1

    def close(self) -> None:
        self.done.append("end all")

    def step(self) -> None:
        self.done.append("step")


def command() -> HeldCommand:
    return HeldCommand({}, {}, 20.0, time.monotonic() + 1.0)


def a_loop(*requests: Request[Any]) -> ObserverLoop:
    loop = ObserverLoop(Pipe()[0])
    for request in requests:
        loop.take(Order(1, request, time.monotonic()))
    return loop


def test_what_cannot_wait_is_done_in_the_middle_of_a_look() -> None:
    desk = Desk("/stop", "/drive")
    node = cast("ObserverNode", desk)
    loop = a_loop(
        Publish("/chatter", BOOL, STOP),
        Hold("/drive", BOOL, command()),
        Publish("/stop", BOOL, STOP, latched=True),
        LetGo("/drive"),
    )
    loop.serve_urgent(node)
    assert desk.done == ["hold /drive", "publish /stop True", "let go of /drive", "step"]
    loop.carry_out(node)
    assert desk.done[4:] == ["look for /chatter", "publish /chatter False"]


def test_what_needs_a_look_itself_waits_for_the_end_of_this_one() -> None:
    desk = Desk()
    node = cast("ObserverNode", desk)
    loop = a_loop(Hold("/drive", BOOL, command()), Publish("/stop", BOOL, STOP, latched=True))
    loop.serve_urgent(node)
    assert desk.done == ["step"]
    loop.carry_out(node)
    assert desk.done[1:] == ["look for /drive", "hold /drive", "look for /stop", "publish /stop True"]


def test_what_was_asked_for_just_before_the_end_of_all_that_is_published_ends_as_well() -> None:
    desk = Desk()
    node = cast("ObserverNode", desk)
    loop = a_loop(StartPublishing("/a", BOOL, STOP, 1.0), StopPublishingAll())
    loop.serve_urgent(node)
    loop.carry_out(node)
    assert desk.done == ["end all", "step", "look for /a", "start /a", "end all"]


def talk(exchange: Exchange, *answers: Any) -> list[NodeRequest]:
    """Give these answers in turn; return the requests."""
    asked = [next(exchange)]
    with contextlib.suppress(StopIteration):
        for answer in answers:
            asked.append(exchange.send(answer))  # noqa: PERF401 - it may end before
    return asked


def state(label: str) -> dict[str, Any]:
    return {"current_state": {"id": 0, "label": label}}


def possible(*transitions: tuple[int, str]) -> dict[str, Any]:
    return {
        "available_transitions": [{"transition": {"id": number, "label": label}} for number, label in transitions]
    }


def test_what_is_not_possible_is_not_asked_for() -> None:
    facts = ChangeFacts("activate")
    asked = talk(change(facts), state("active"), possible((4, "deactivate")))
    assert [request.service for request in asked] == ["get_state", "get_available_transitions"]
    assert (facts.success, facts.after.state) == (None, "active")


@pytest.mark.parametrize("given", ["configure", "1"])
def test_a_transition_is_asked_for_by_number_and_name_and_given_time(given: str) -> None:
    facts = ChangeFacts(given)
    configure = possible((1, "configure"))
    asked = talk(
        change(facts),
        state("unconfigured"), configure, {"success": True}, state("inactive"), possible(),
    )  # fmt: skip
    wanted: dict[str, Value] = {"transition": {"id": 1, "label": "configure"}}
    assert asked[2] == NodeRequest("change_state", wanted, CHANGE_WITHIN_S)
    assert (facts.transition, facts.success, facts.after.state) == ("configure", True, "inactive")


def test_only_a_node_that_serves_its_state_by_the_right_type_is_managed() -> None:
    kind = "lifecycle_msgs/srv/GetState"
    rows = (
        ServiceRow("/arm/a/get_state", (kind,), ("/arm/a",)),
        ServiceRow("/b/get_state", ("std_srvs/srv/Trigger",), ("/b",)),
        ServiceRow("/get_state", (kind,), ("/c",)),
        ServiceRow("/d/state", (kind,), ("/d",)),
    )
    assert managed(rows) == {"/arm/a"}


def test_the_level_in_effect_is_that_of_the_next_logger_above() -> None:
    found: list[str] = []
    told = [{"name": name, "level": number} for name, number in (("a.b", 0), ("a", 40), ("", 20))]
    (asked, *_) = talk(read_level("a.b", found), {"levels": told})
    assert asked.value == {"names": ["a.b", "a", ""]}
    assert found == ["error"]
    talk(read_level("a", found), {"levels": [{"name": "a", "level": 0}]})
    assert found == ["info"]
    talk(read_level("a", found), {"levels": [{"name": "a", "level": 25}]})
    assert found == ["25"]


class Publisher:
    """Counts what is published; fails when it is told to."""

    def __init__(self) -> None:
        self.published: list[bytes] = []
        self.fails = False

    def publish(self, raw: bytes) -> None:
        if self.fails:
            raise RuntimeError("the middleware is full")
        self.published.append(raw)

    def get_subscription_count(self) -> int:
        return 3


def repeated(hz: float, publisher: Publisher) -> _Repeated:
    return _Repeated(1, "/t", "a/msg/B", hz, b"raw", object, Qos(RELIABLE, VOLATILE), cast("Any", publisher), 0.0)


@given(st.floats(0.1, 100), st.lists(st.floats(0, LATE_S / 2), max_size=200))
def test_the_mean_rate_is_exact_however_late_each_step_comes(hz: float, pauses: list[float]) -> None:
    publisher = Publisher()
    one, now_s = repeated(hz, publisher), 0.0
    one.step(now_s)
    for pause_s in pauses:
        now_s += pause_s
        one.step(now_s)
    assert len(publisher.published) == pytest.approx(now_s * hz + 1, abs=1.001)
    assert one.due_s > now_s
    assert one.row().sent == len(publisher.published)


def test_what_was_slept_through_is_not_made_up_for() -> None:
    publisher = Publisher()
    one = repeated(10.0, publisher)
    one.step(0.0)
    one.step(60.0)
    assert len(publisher.published) == 2
    assert one.due_s == pytest.approx(60.1)


GO, OTHER, REST = {"speed": 0.2}, {"speed": -0.2}, {"speed": 0.0}


class Wire:
    """What has been published."""

    def __init__(self) -> None:
        self.sent: list[Mapping[str, Any]] = []
        self.fails = False

    def __call__(self, value: Mapping[str, Any]) -> None:
        if self.fails:
            raise RuntimeError("the middleware is full")
        self.sent.append(value)


def command_dead_man_switch(until_s: float, value: Mapping[str, Any] = GO) -> HeldCommand:
    return HeldCommand(value, REST, 20.0, until_s)


def test_it_goes_out_at_once_at_its_rate_and_rests_on_time() -> None:
    wire = Wire()
    repeater = CommandRepeater(wire)
    repeater.hold(command_dead_man_switch(10.12), 10.0)
    assert wire.sent == [GO]
    assert repeater.step(10.01) == pytest.approx(10.05)
    assert repeater.step(10.06) == pytest.approx(10.10)
    assert repeater.step(10.11) == pytest.approx(10.12)
    repeater.step(10.12)
    assert wire.sent == [GO, GO, GO, REST]


def test_a_word_that_comes_too_late_moves_nothing() -> None:
    wire = Wire()
    repeater = CommandRepeater(wire)
    repeater.hold(command_dead_man_switch(10.0), 10.0)
    assert wire.sent == []
    assert not repeater.is_held


def test_letting_go_rests_at_once() -> None:
    wire = Wire()
    repeater = CommandRepeater(wire)
    repeater.let_go(10.0)
    assert wire.sent == []
    repeater.hold(command_dead_man_switch(11.0), 10.0)
    repeater.let_go(10.01)
    assert wire.sent == [GO, REST]


def test_what_cannot_be_published_is_held_no_more() -> None:
    wire = Wire()
    repeater = CommandRepeater(wire)
    wire.fails = True
    with pytest.raises(RuntimeError):
        repeater.hold(command_dead_man_switch(11.0), 10.0)
    assert not repeater.is_held
    wire.fails = False
    assert repeater.step(10.1) is None
    assert wire.sent == []


acts = st.lists(
    st.tuples(st.floats(0.0, 0.7), st.sampled_from(["hold", "other", "let go", "step"]), st.floats(-1, 3)),
    max_size=40,
)


@given(acts)
def test_whatever_is_said_it_ends_at_rest(history: list[tuple[float, str, float]]) -> None:
    wire = Wire()
    repeater, now_s, good_until_s = CommandRepeater(wire), 100.0, 0.0
    for pause_s, what, good_for_s in history:
        now_s += pause_s
        before = len(wire.sent)
        if what in {"hold", "other"}:
            repeater.hold(command_dead_man_switch(now_s + good_for_s, GO if what == "hold" else OTHER), now_s)
            if now_s + good_for_s > now_s:
                good_until_s = now_s + good_for_s
        elif what == "let go":
            repeater.let_go(now_s)
            good_until_s = min(good_until_s, now_s)
        else:
            repeater.step(now_s)
        if now_s >= good_until_s:
            assert all(value == REST for value in wire.sent[before:])
    repeater.step(now_s + 3.0)
    assert not wire.sent or wire.sent[-1] == REST
    assert not repeater.is_held


ID = bytes(range(16))
EXECUTING, SUCCEEDED, ABORTED = 2, 4, 6


class GoalClient:
    """Remembers what was sent, by number."""

    def __init__(self) -> None:
        self.is_ready = True
        self.there = frozenset({b"server"})
        self.sent: list[str] = []

    def servers(self) -> frozenset[bytes]:
        return self.there

    def send(self, _id: bytes, _goal: Any) -> int:
        return self._number("goal")

    def ask_result(self, _id: bytes) -> int:
        return self._number("result")

    def cancel(self, _id: bytes) -> int:
        return self._number("cancel")

    def _number(self, what: str) -> int:
        self.sent.append(what)
        return len(self.sent)


class Clock:
    """A clock that is moved by hand."""

    def __init__(self) -> None:
        self.now_s = 100.0

    def monotonic(self) -> float:
        return self.now_s


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(goals_life, "time", clock)
    return clock


@pytest.fixture
def client() -> GoalClient:
    return GoalClient()


@pytest.fixture
def life(clock: Clock, client: GoalClient) -> GoalLife:
    assert clock.now_s == 100.0
    told = Goal(1, "/drive", "t", GoalStatus.SENDING, {})
    return GoalLife(told, ID, Draft(None), cast("Any", client))


def go(life: GoalLife, **heard: Any) -> GoalStatus:
    life.hear(GoalAnswers(**heard))
    life.act()
    return life.told.status


def result(status: int, message: str = "") -> Any:
    return SimpleNamespace(status=status, result=DriveToPoint.Result(message=message))


def test_a_goal_whose_acceptance_was_lost_is_known_by_its_status(life: GoalLife, client: GoalClient) -> None:
    go(life)
    assert go(life, status={ID: EXECUTING}) == GoalStatus.EXECUTING
    assert client.sent == ["goal", "result"]
    # The answer that comes after all changes nothing.
    assert go(life, accepted={1: True}) == GoalStatus.EXECUTING
    assert client.sent == ["goal", "result"]
    assert go(life, results={2: result(SUCCEEDED)}) == GoalStatus.SUCCEEDED


def test_what_is_accepted_after_it_was_given_up_is_cancelled(
    life: GoalLife, client: GoalClient, clock: Clock
) -> None:
    go(life)
    clock.now_s += ANSWER_WITHIN_S
    assert go(life) == GoalStatus.FAILED
    assert life.told.error == "no answer within 5 s"
    assert not life.is_settled
    go(life, accepted={1: True})
    assert "cancel" in client.sent
    assert not life.is_settled
    go(life, cancelled={3: True})
    assert life.is_settled


def test_a_server_that_ignores_the_cancelling_is_told_and_can_be_asked_again(
    life: GoalLife, client: GoalClient, clock: Clock
) -> None:
    go(life)
    go(life, accepted={1: True}, status={ID: EXECUTING})
    life.cancel()
    go(life)
    assert life.is_urgent
    clock.now_s += ANSWER_WITHIN_S
    assert go(life) == GoalStatus.EXECUTING
    assert life.told.error == "no answer to the request to cancel it within 5 s"
    life.cancel()
    go(life)
    assert client.sent.count("cancel") == 2

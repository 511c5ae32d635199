"""The life of a goal against a server that answers late, oddly or not at all."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest
from deck_interfaces.action import DriveToPoint

from graph.calls import goal_life as goals_life
from graph.calls.action_client import GoalAnswers
from graph.calls.goal_life import GONE_AFTER_S, GoalLife
from graph.calls.timeouts import ANSWER_WITHIN_S
from graph.data import Goal, GoalStatus
from graph.messages.dated import Draft

ID = bytes(range(16))
EXECUTING, SUCCEEDED, ABORTED = 2, 4, 6


class Client:
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
def client() -> Client:
    return Client()


@pytest.fixture
def life(clock: Clock, client: Client) -> GoalLife:
    assert clock.now_s == 100.0
    told = Goal(1, "/drive", "t", GoalStatus.SENDING, {})
    return GoalLife(told, ID, Draft(None), cast("Any", client))


def go(life: GoalLife, **heard: Any) -> GoalStatus:
    life.hear(GoalAnswers(**heard))
    life.act()
    return life.told.status


def result(status: int, message: str = "") -> Any:
    return SimpleNamespace(status=status, result=DriveToPoint.Result(message=message))


def test_a_goal_whose_acceptance_was_lost_is_known_by_its_status(
    life: GoalLife, client: Client
) -> None:
    go(life)
    assert go(life, status={ID: EXECUTING}) == GoalStatus.EXECUTING
    assert client.sent == ["goal", "result"]
    # The answer that comes after all changes nothing.
    assert go(life, accepted={1: True}) == GoalStatus.EXECUTING
    assert client.sent == ["goal", "result"]
    assert go(life, results={2: result(SUCCEEDED)}) == GoalStatus.SUCCEEDED


def test_what_is_accepted_after_it_was_given_up_is_cancelled(
    life: GoalLife, client: Client, clock: Clock
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


def test_what_was_given_up_is_settled_when_its_server_has_gone(
    life: GoalLife, client: Client, clock: Clock
) -> None:
    go(life)
    clock.now_s += ANSWER_WITHIN_S
    go(life)
    client.there = frozenset()
    assert life.is_settled


def test_another_server_in_its_place_is_not_its_server(
    life: GoalLife, client: Client, clock: Clock
) -> None:
    go(life)
    go(life, accepted={1: True})
    client.there = frozenset({b"another"})
    assert go(life) == GoalStatus.ACCEPTED
    clock.now_s += GONE_AFTER_S
    assert go(life) == GoalStatus.FAILED
    assert life.told.error == "its server has left the graph"


def test_a_result_that_comes_from_the_dead_still_counts(
    life: GoalLife, client: Client, clock: Clock
) -> None:
    go(life)
    go(life, accepted={1: True})
    client.there = frozenset()
    go(life)
    clock.now_s += GONE_AFTER_S
    assert go(life) == GoalStatus.FAILED
    assert go(life, results={2: result(ABORTED, "a wall")}) == GoalStatus.ABORTED
    assert life.told.error == "a wall"


def test_one_that_seemed_gone_can_still_be_cancelled(
    life: GoalLife, client: Client, clock: Clock
) -> None:
    go(life)
    go(life, accepted={1: True})
    client.there = frozenset()
    go(life)
    clock.now_s += GONE_AFTER_S
    go(life)
    life.cancel()
    go(life)
    assert client.sent == ["goal", "result", "cancel"]


def test_an_end_whose_result_never_comes_is_told(life: GoalLife, clock: Clock) -> None:
    go(life)
    go(life, accepted={1: True}, status={ID: SUCCEEDED})
    clock.now_s += ANSWER_WITHIN_S
    assert go(life) == GoalStatus.FAILED
    assert life.told.error == "it has ended, but its result has not arrived"


def test_a_server_that_ignores_the_cancelling_is_told_and_can_be_asked_again(
    life: GoalLife, client: Client, clock: Clock
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


def test_the_time_that_it_took_stands_still_at_its_end(life: GoalLife, clock: Clock) -> None:
    go(life)
    clock.now_s += 2.0
    assert life.snapshot().elapsed_s == 2.0
    go(life, accepted={1: False})
    clock.now_s += 2.0
    assert life.snapshot().status == GoalStatus.REJECTED
    assert life.snapshot().elapsed_s == 2.0

"""Goals that others have sent: seen as their server tells of them, and cancelled if need be."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from graph.calls import goal_cancel as goals_cancel
from graph.data import GoalStatus, SeenGoal
from tests.ros.observing import Peer, Watcher
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

DRIVE = "deck_interfaces/action/DriveToPoint"
CANCELED = 5
"""Of action_msgs/GoalStatus."""


@pytest.fixture(scope="module")
def driver(module_domain: int) -> Iterator[Peer]:
    driver = Peer("driver", module_domain)
    yield driver
    driver.close()


@pytest.fixture(scope="module")
def stranger(module_domain: int) -> Iterator[Peer]:
    stranger = Peer("stranger", module_domain)
    yield stranger
    stranger.close()


@pytest.fixture(scope="module")
def watcher(module_domain: int) -> Iterator[Watcher]:
    watcher = Watcher(module_domain)
    yield watcher
    watcher.close()


@pytest.fixture
def server(driver: Peer, request: pytest.FixtureRequest) -> Peer:
    """The driver, with an action that only this test knows."""
    driver.action = f"/{request.node.originalname}"
    driver.serve_action(driver.action)
    return driver


def seen(watcher: Watcher, *statuses: GoalStatus) -> list[SeenGoal]:
    """Wait until the goals of others are seen to stand so."""
    return wait_until(
        lambda: (
            [goal.status for goal in watcher.update.seen_goals] == list(statuses)
            and list(watcher.update.seen_goals)
        ),
        lambda: f"{statuses}, not {watcher.update.seen_goals}",
    )


def at_work(server: Peer, stranger: Peer, x: float = 1.0) -> None:
    """A goal of the stranger's that the server executes."""
    stranger.send_drive(server.action, x=x)
    wait_until(lambda: [x, 0.0] in server.goals(server.action), "the goal at its server")


def test_goals_of_others_are_told_with_status_age_and_feedback_also_those_of_before(
    watcher: Watcher, server: Peer, stranger: Peer
) -> None:
    at_work(server, stranger, 1.0)
    at_work(server, stranger, 2.0)
    watcher.observer.watch_goals([server.action])
    first, second = seen(watcher, GoalStatus.EXECUTING, GoalStatus.EXECUTING)
    assert (first.action, first.type_name, len(first.goal_id)) == (server.action, DRIVE, 32)
    assert first.goal_id != second.goal_id
    assert first.age_s is not None
    assert second.age_s is not None
    assert first.age_s > second.age_s > 0
    assert watcher.update.goals == ()

    def fed() -> SeenGoal | None:
        server.feedback(server.action, goal=1, distance=0.5)
        last = watcher.update.seen_goals[-1]
        return last if last.feedback_count else None

    assert wait_until(fed, "feedback").feedback == {"distance": 0.5}
    server.finish(server.action, goal=0, how="succeed")
    server.finish(server.action, goal=1, how="abort")
    first, second = seen(watcher, GoalStatus.SUCCEEDED, GoalStatus.ABORTED)
    assert (first.ended, second.ended, first.error) == (True, True, "")
    watcher.observer.watch_goals([])
    wait_until(lambda: not watcher.update.seen_goals, "nobody looks any more")


def test_how_long_a_goal_took_is_not_told_where_nobody_has_seen_its_end(
    watcher: Watcher, server: Peer, stranger: Peer
) -> None:
    at_work(server, stranger, 1.0)
    watcher.observer.watch_goals([server.action])
    seen(watcher, GoalStatus.EXECUTING)
    server.finish(server.action, goal=0, how="succeed")
    (goal,) = seen(watcher, GoalStatus.SUCCEEDED)
    assert goal.age_s is not None
    watcher.observer.watch_goals([])
    wait_until(lambda: not watcher.update.seen_goals, "nobody looks any more")
    watcher.observer.watch_goals([server.action])
    (goal,) = seen(watcher, GoalStatus.SUCCEEDED)
    assert goal.age_s is None


def test_a_goal_of_decks_own_is_not_one_of_others(
    watcher: Watcher, server: Peer, stranger: Peer
) -> None:
    watcher.observer.watch_goals([server.action])
    number = watcher.observer.send_goal(server.action, DRIVE, {"x": 5.0}).result(30)
    wait_until(lambda: [5.0, 0.0] in server.goals(server.action), "the goal at its server")
    at_work(server, stranger, 6.0)
    (other,) = seen(watcher, GoalStatus.EXECUTING)
    (own,) = watcher.update.goals
    assert len(own.goal_id) == 32
    assert own.goal_id != other.goal_id
    server.finish(server.action, goal=0, how="succeed")
    wait_until(lambda: watcher.update.goals[0].ended, "the end of its own")
    # Nor is it one of theirs when it is forgotten, though its server still tells of it.
    watcher.observer.forget_goal(number)
    wait_until(lambda: not watcher.update.goals, "no goals")
    server.finish(server.action, goal=1, how="succeed")
    seen(watcher, GoalStatus.SUCCEEDED)


def test_a_goal_of_another_is_cancelled_that_one_alone_and_its_client_is_told(
    watcher: Watcher, server: Peer, stranger: Peer
) -> None:
    at_work(server, stranger, 1.0)
    at_work(server, stranger, 2.0)
    watcher.observer.watch_goals([server.action])
    _first, second = seen(watcher, GoalStatus.EXECUTING, GoalStatus.EXECUTING)
    watcher.observer.cancel_seen_goal(server.action, second.goal_id)
    seen(watcher, GoalStatus.EXECUTING, GoalStatus.CANCELING)
    server.finish(server.action, goal=1, how="canceled")
    wait_until(lambda: stranger.ends(server.action) == {"1": CANCELED}, "a word to its client")
    (first, second) = seen(watcher, GoalStatus.EXECUTING, GoalStatus.CANCELED)
    assert server.cancels(server.action) == 1
    assert first.error == second.error == ""
    server.finish(server.action, goal=0, how="succeed")


def told_why(watcher: Watcher) -> str:
    return wait_until(lambda: watcher.update.seen_goals[0].error, "a word why not")


def test_a_server_that_refuses_or_does_not_answer_is_told(
    watcher: Watcher, server: Peer, stranger: Peer, monkeypatch: pytest.MonkeyPatch
) -> None:
    server.serve_action(f"{server.action}_stubborn", refuse_cancel=True)
    server.action += "_stubborn"
    at_work(server, stranger)
    watcher.observer.watch_goals([server.action])
    (goal,) = seen(watcher, GoalStatus.EXECUTING)
    watcher.observer.cancel_seen_goal(server.action, goal.goal_id)
    assert told_why(watcher) == "the server refuses to cancel it"
    monkeypatch.setattr(goals_cancel, "ANSWER_WITHIN_S", 0.0)
    watcher.observer.cancel_seen_goal(server.action, goal.goal_id)
    wait_until(lambda: "within 0 s" in watcher.update.seen_goals[0].error, "given up")
    assert watcher.update.seen_goals[0].status is GoalStatus.EXECUTING
    server.finish(server.action, goal=0, how="succeed")
    seen(watcher, GoalStatus.SUCCEEDED)


def test_goals_whose_server_has_left_are_lost(
    watcher: Watcher, server: Peer, stranger: Peer
) -> None:
    at_work(server, stranger)
    watcher.observer.watch_goals([server.action])
    seen(watcher, GoalStatus.EXECUTING)
    server.withdraw_action(server.action)
    (lost,) = seen(watcher, GoalStatus.FAILED)
    assert lost.error == "its server has left the graph"


def test_nothing_but_the_goal_that_was_named_can_be_cancelled(
    watcher: Watcher, server: Peer, stranger: Peer
) -> None:
    at_work(server, stranger)
    watcher.observer.watch_goals([server.action])
    seen(watcher, GoalStatus.EXECUTING)
    # An id of zeros would cancel every goal there is.
    for wrong in ("0" * 32, "f" * 32):
        watcher.observer.cancel_seen_goal(server.action, wrong)
    # Orders are carried out in turn: when this one is over, those before it are.
    assert watcher.observer.call("/nobody", "std_srvs/srv/Nothing", {}, 0.1).result(30).error
    assert server.cancels(server.action) == 0
    server.finish(server.action, goal=0, how="succeed")
    seen(watcher, GoalStatus.SUCCEEDED)

"""Goals to real action servers: accepted, watched, cancelled, ended; or in words why not."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from graph.calls import goal_life as goals_life
from graph.calls.goals import GoalError
from graph.data import Goal, GoalStatus
from graph.messages.making import FieldError
from graph.messages.types import UnknownTypeError
from graph.observer.requests import ObserverError
from tests.ros.observing import Peer, Watcher
from tests.waiting import wait_until

DRIVE = "deck_interfaces/action/DriveToPoint"


SHORT_LEASE = """\
<profiles xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <participant profile_name="mortal" is_default_profile="true">
    <rtps><builtin><discovery_config>
      <leaseDuration><sec>4</sec></leaseDuration>
      <leaseAnnouncement><sec>0</sec><nanosec>200000000</nanosec></leaseAnnouncement>
    </discovery_config></builtin></rtps>
  </participant>
</profiles>
"""
"""A node that is killed is missed after this time, in place of 20 s."""


@pytest.fixture(scope="module")
def driver(module_domain: int) -> Iterator[Peer]:
    driver = Peer("driver", module_domain)
    driver.serve_action("/drive_to")
    yield driver
    driver.close()


@pytest.fixture
def server(driver: Peer, request: pytest.FixtureRequest) -> Peer:
    """The driver, with an action that only this test knows."""
    driver.action = f"/{request.node.originalname}"
    driver.serve_action(driver.action)
    return driver


@pytest.fixture(scope="module")
def observing(module_domain: int) -> Iterator[Watcher]:
    watcher = Watcher(module_domain)
    yield watcher
    watcher.close()


@pytest.fixture
def watcher(observing: Watcher) -> Iterator[Watcher]:
    """The observer of all tests, without the goals of the others."""
    yield observing
    for each in observing.update.goals:
        observing.observer.forget_goal(each.number)
    wait_until(lambda: not observing.update.goals, "no goals")


def send(watcher: Watcher, action: str, x: float = 1.0) -> int:
    return watcher.observer.send_goal(action, DRIVE, {"x": x}).result(30)


def goal(watcher: Watcher, number: int) -> Goal | None:
    return next((each for each in watcher.update.goals if each.number == number), None)


def wait_for(watcher: Watcher, number: int, *statuses: GoalStatus) -> Goal:
    def has() -> Goal | None:
        found = goal(watcher, number)
        return found if found and found.status in statuses else None

    return wait_until(has, f"goal {number} is one of {statuses}, not {goal(watcher, number)}")


def at_work(watcher: Watcher, server: Peer, x: float = 1.0, action: str = "") -> int:
    """A goal that the server executes."""
    action = action or server.action
    number = send(watcher, action, x)
    wait_until(lambda: [x, 0.0] in server.goals(action), "the goal at its server")
    wait_for(watcher, number, GoalStatus.EXECUTING)
    return number


def test_a_goal_is_accepted_executed_and_succeeds(watcher: Watcher, server: Peer) -> None:
    number = at_work(watcher, server, 2.0)
    server.feedback(server.action, goal=0, distance=1.5)
    server.feedback(server.action, goal=0, distance=0.5)

    def fed() -> Goal | None:
        found = goal(watcher, number)
        return found if found and found.feedback_count == 2 else None

    told = wait_until(fed, "two feedbacks")
    assert told.feedback == {"distance": 0.5}
    assert told.goal == {"x": 2.0, "y": 0.0, "tolerance": 0.0}
    assert (told.result, told.error, told.ended) == (None, "", False)
    server.finish(server.action, goal=0, how="succeed", reached=True, distance=0.1)
    told = wait_for(watcher, number, GoalStatus.SUCCEEDED)
    assert told.result == {"reached": True, "distance": 0.1, "message": ""}
    assert (told.error, told.ended, told.action, told.type_name) == ("", True, server.action, DRIVE)
    assert told.elapsed_s > 0
    watcher.observer.forget_goal(number)
    wait_until(lambda: not watcher.update.goals, "the goal is forgotten")


def test_several_goals_at_once_are_each_their_own(watcher: Watcher, server: Peer) -> None:
    server.serve_action("/other")
    first, second = at_work(watcher, server, 1.0), at_work(watcher, server, 2.0)
    third = at_work(watcher, server, 3.0, "/other")
    assert [each.number for each in watcher.update.goals] == [first, second, third]
    server.feedback(server.action, goal=1, distance=7.0)
    server.finish(server.action, goal=1, how="succeed", message="second")
    server.finish("/other", goal=0, how="abort", message="third")
    assert wait_for(watcher, second, GoalStatus.SUCCEEDED).feedback == {"distance": 7.0}
    assert wait_for(watcher, third, GoalStatus.ABORTED).error == "third"
    assert wait_for(watcher, first, GoalStatus.EXECUTING).feedback is None
    server.finish(server.action, goal=0, how="succeed")
    wait_for(watcher, first, GoalStatus.SUCCEEDED)


def test_a_rejected_goal_is_told(watcher: Watcher, server: Peer) -> None:
    server.serve_action("/strict", reject=True)
    told = wait_for(watcher, send(watcher, "/strict"), GoalStatus.REJECTED)
    assert (told.error, told.ended) == ("the server rejected it", True)


def test_an_aborted_goal_gives_its_reason_and_its_result(watcher: Watcher, server: Peer) -> None:
    number = at_work(watcher, server)
    server.finish(server.action, goal=0, how="abort", message="a wall", distance=3.0)
    told = wait_for(watcher, number, GoalStatus.ABORTED)
    assert told.error == "a wall"
    assert told.result == {"reached": False, "distance": 3.0, "message": "a wall"}


def test_a_goal_is_cancelled(watcher: Watcher, server: Peer) -> None:
    number = at_work(watcher, server)
    watcher.observer.cancel_goal(number)
    wait_for(watcher, number, GoalStatus.CANCELING)
    server.finish(server.action, goal=0, how="canceled", distance=2.0)
    told = wait_for(watcher, number, GoalStatus.CANCELED)
    assert (told.error, told.result) == ("", {"reached": False, "distance": 2.0, "message": ""})


def test_a_server_that_refuses_to_cancel_is_told_and_the_goal_goes_on(
    watcher: Watcher, server: Peer
) -> None:
    server.serve_action("/stubborn", refuse_cancel=True)
    number = at_work(watcher, server, action="/stubborn")
    watcher.observer.cancel_goal(number)

    def refused() -> Goal | None:
        found = goal(watcher, number)
        return found if found and found.error else None

    told = wait_until(refused, "a word")
    assert (told.error, told.status) == ("the server refuses to cancel it", GoalStatus.EXECUTING)
    server.finish("/stubborn", goal=0, how="succeed")
    assert wait_for(watcher, number, GoalStatus.SUCCEEDED).error == ""


def test_a_goal_that_is_forgotten_while_it_runs_is_cancelled(
    watcher: Watcher, server: Peer
) -> None:
    number = at_work(watcher, server)
    watcher.observer.forget_goal(number)
    wait_until(lambda: not watcher.update.goals, "the goal is forgotten")
    wait_until(lambda: server.cancels(server.action) == 1, "its server is asked to cancel")


def test_goals_that_run_are_cancelled_with_all_that_commands(
    watcher: Watcher, server: Peer
) -> None:
    at_work(watcher, server)
    watcher.observer.stop_commanding()
    wait_until(lambda: server.cancels(server.action) == 1, "its server is asked to cancel")


def test_goals_that_run_are_cancelled_when_the_observer_stops(
    server: Peer, module_domain: int
) -> None:
    watcher = Watcher(module_domain)
    at_work(watcher, server)
    watcher.close()
    assert server.cancels(server.action) == 1
    with pytest.raises(ObserverError):
        watcher.observer.send_goal(server.action, DRIVE, {}).result(10)
    watcher.observer.cancel_goal(1)
    watcher.observer.forget_goal(1)


def test_a_server_that_leaves_in_mid_goal_is_told(watcher: Watcher, server: Peer) -> None:
    number = at_work(watcher, server)
    server.withdraw_action(server.action)
    told = wait_for(watcher, number, GoalStatus.FAILED)
    assert told.error == "its server has left the graph"


def test_a_server_that_is_killed_in_mid_goal_is_told_though_another_takes_its_place(
    watcher: Watcher, module_domain: int, tmp_path: Path
) -> None:
    profile = tmp_path / "short_lease.xml"
    profile.write_text(SHORT_LEASE)
    first = Peer("mortal", module_domain, fast_dds=profile)
    first.serve_action("/mortal")
    number = at_work(watcher, first, action="/mortal")
    first.kill()
    second = Peer("mortal", module_domain)
    second.serve_action("/mortal")
    assert wait_for(watcher, number, GoalStatus.FAILED).error == "its server has left the graph"
    again = at_work(watcher, second, 5.0, "/mortal")
    second.finish("/mortal", goal=0, how="succeed")
    wait_for(watcher, again, GoalStatus.SUCCEEDED)
    second.close()
    first.close()


def test_a_server_that_does_not_answer_is_given_up_and_what_it_takes_later_is_cancelled(
    watcher: Watcher, server: Peer, monkeypatch: pytest.MonkeyPatch
) -> None:
    action = server.action
    wait_until(lambda: any(a.name == action for a in watcher.update.actions), "the action")
    monkeypatch.setattr(goals_life, "ANSWER_WITHIN_S", 1.5)
    os.kill(server.process.pid, signal.SIGSTOP)
    number = send(watcher, action)
    try:
        told = wait_for(watcher, number, GoalStatus.FAILED)
        assert "within 1.5 s" in told.error
        assert told.elapsed_s >= 1.5
    finally:
        os.kill(server.process.pid, signal.SIGCONT)
    if told.error == "no answer within 1.5 s":
        wait_until(lambda: server.cancels(action) == 1, "the late goal is cancelled")


def test_an_action_that_nobody_serves_is_named(
    watcher: Watcher, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(goals_life, "ANSWER_WITHIN_S", 0.5)
    told = wait_for(watcher, send(watcher, "/nobody"), GoalStatus.FAILED)
    assert told.error == "no server appeared within 0.5 s"


def test_a_goal_that_is_cancelled_before_it_is_sent_never_is(watcher: Watcher) -> None:
    number = send(watcher, "/nobody")
    watcher.observer.cancel_goal(number)
    told = wait_for(watcher, number, GoalStatus.CANCELED)
    assert told.error == "it was cancelled before it was sent"


@pytest.mark.parametrize(
    ("action", "type_name", "values", "kind", "words"),
    [
        ("/drive_to", DRIVE, {"z": 1}, FieldError, "z: no such field"),
        ("/drive_to", DRIVE, {"x": "far"}, FieldError, "x: expected a number, got 'far'"),
        ("/free", "foo_msgs/action/Bar", {}, UnknownTypeError, "foo_msgs is not installed"),
        ("/free", "std_msgs/msg/Bool", {}, UnknownTypeError, "write it as package/action/Name"),
        ("/a name", DRIVE, {}, GoalError, "/a name cannot be sent a goal"),
        (
            "/drive_to",
            "example_interfaces/action/Fibonacci",
            {},
            GoalError,
            f"/drive_to is a {DRIVE}, not a example_interfaces/action/Fibonacci",
        ),
    ],
)
def test_what_cannot_be_sent_is_refused_in_words(
    watcher: Watcher,
    driver: Peer,
    action: str,
    type_name: str,
    values: dict[str, Any],
    kind: type[Exception],
    words: str,
) -> None:
    assert driver.goals("/drive_to") == []
    wait_until(lambda: any(a.name == "/drive_to" for a in watcher.update.actions), "the action")
    with pytest.raises(kind, match=words):
        watcher.observer.send_goal(action, type_name, values).result(30)
    assert watcher.update.goals == ()

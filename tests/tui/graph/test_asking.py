"""Calling services and sending goals on the screen of the graph."""

from __future__ import annotations

from collections.abc import AsyncIterator
from concurrent.futures import Future
from contextlib import asynccontextmanager
from dataclasses import replace

import pytest
from textual.widgets import Input

from graph.data import CallResult, GoalStatus, SeenGoal
from graph.observer.requests import CallService, CancelGoal, CancelSeenGoal, ForgetGoal, SendGoal
from tests.tui.graph_stage import GraphStage, opened
from tests.tui.recorded import RecordedGraph
from tui.graph.index import GraphKind, GraphPlace

pytestmark = pytest.mark.nightly

SERVICE, ADD = "/set_head_position", "example_interfaces/srv/AddTwoInts"
ACTION, DRIVE = "/drive_to_point", "deck_interfaces/action/DriveToPoint"


@asynccontextmanager
async def at(place: GraphPlace, graph: RecordedGraph | None = None) -> AsyncIterator[GraphStage]:
    """Open the screen with the form of this place filled in by its defaults."""
    async with opened(graph) as stage:
        await stage.screen.go(place)
        await stage.wait_for("✓ valid ")
        await stage.press("enter")
        yield stage


@pytest.fixture
async def service() -> AsyncIterator[GraphStage]:
    async with at(GraphPlace(GraphKind.SERVICE, SERVICE)) as stage:
        yield stage


@pytest.fixture
async def action() -> AsyncIterator[GraphStage]:
    async with at(GraphPlace(GraphKind.ACTION, ACTION)) as stage:
        yield stage


def fill(stage: GraphStage, text: str) -> None:
    pane = stage.screen.ask_pane
    assert pane is not None
    pane.form.editor.replace_all(text)


async def test_a_service_is_called_and_its_answer_shown_with_its_time(service: GraphStage) -> None:
    assert "not called yet" in service.seen()
    fill(service, "a: 30\nb: -10\n")
    await service.press("ctrl+s")
    await service.wait_for("Response in 12.0 ms")
    assert service.graph.asked(CallService)[0][:3] == (SERVICE, ADD, {"a": 30, "b": -10})
    await service.wait_for("sum: 1")
    assert "a 30, b -10 → sum 1" in service.seen()


async def test_a_wrong_request_is_not_sent(service: GraphStage) -> None:
    fill(service, "a: much\n")
    await service.press("ctrl+s")
    assert service.graph.asked(CallService) == []
    assert "✗" in service.seen()


def time_is_over(stage: GraphStage) -> Future[CallResult]:
    """Let the time of the newest call pass; the future is for what still comes of it."""
    late: Future[CallResult] = Future()
    why = "/set_head_position: no answer within 5 s"
    stage.graph.waiting[-1].set_result(CallResult(SERVICE, False, None, why, 5.0, late))
    return late


def timeout_field(stage: GraphStage) -> Input:
    return stage.screen.query_one("#call-timeout", Input)


async def test_the_time_out_is_chosen_below_the_form_and_each_service_keeps_its_own(service: GraphStage) -> None:
    service.graph.hold_calls = True
    assert timeout_field(service).value == "5"
    timeout_field(service).focus()
    await service.press("backspace", "3", "0", "ctrl+s")
    await service.wait_for("Still waiting: 0 s of 30 s")
    assert [asked[-1] for asked in service.graph.asked(CallService)] == [30.0]
    await service.screen.go(GraphPlace(GraphKind.SERVICE, "/camera/set_parameters"))
    await service.wait_for("valid rcl_interfaces/srv/SetParameters")
    assert timeout_field(service).value == "5"
    await service.screen.go(GraphPlace(GraphKind.SERVICE, SERVICE))
    await service.wait_for("Still waiting: 0 s of 30 s")
    assert timeout_field(service).value == "30"


async def test_a_late_answer_is_told_wherever_one_is_and_shown_as_late(service: GraphStage) -> None:
    service.graph.hold_calls = True
    await service.press("ctrl+s")
    await service.wait_for("Still waiting")
    late = time_is_over(service)
    await service.wait_for("No response within 5 s")
    assert "A late response will be shown here" in " ".join(service.seen().split())
    await service.app.show_screen("topics")
    late.set_result(CallResult(SERVICE, True, {"sum": 42}, "", 7.04))
    told = f"{SERVICE}: the response arrived after 7.0 s."
    await service.wait(lambda: told in [one.message for one in service.app._notifications])
    await service.app.show_screen("graph")
    await service.wait_for("Late response after 7.0 s (time-out 5 s)")
    await service.wait_for("sum: 42")


async def test_a_call_that_fails_says_why(service: GraphStage) -> None:
    why = "no answer within 5 s"
    service.graph.answers[SERVICE] = CallResult(SERVICE, False, None, why, 5.0)
    await service.press("ctrl+s")
    await service.wait_for("the call failed")
    assert why in service.seen()
    assert "No response · 5000.0 ms" in service.seen()


async def test_a_goal_is_sent_and_its_feedback_and_result_are_shown(action: GraphStage) -> None:
    fill(action, "x: 1.0\ny: 2.0\ntolerance: 0.1\n")
    await action.press("ctrl+s")
    await action.wait(lambda: action.graph.asked(SendGoal))
    assert action.graph.asked(SendGoal) == [(ACTION, DRIVE, {"x": 1.0, "y": 2.0, "tolerance": 0.1})]
    await action.wait_for("#1 ◌ sending")
    status = GoalStatus.EXECUTING
    action.graph.change_goal(1, status=status, feedback={"distance": 1.5}, feedback_count=2)
    await action.wait_for("distance: 1.5")
    assert "● executing" in action.seen()
    status = GoalStatus.SUCCEEDED
    action.graph.change_goal(1, status=status, result={"reached": True}, elapsed_s=4.2)
    await action.wait_for("reached: true")
    assert "✓ succeeded" in action.seen()
    assert "4.2 s" in action.seen()


async def test_a_goal_that_is_refused_says_why(action: GraphStage) -> None:
    await action.press("ctrl+s")
    await action.wait_for("#1")
    action.graph.change_goal(1, status=GoalStatus.REJECTED, error="the point is too far")
    await action.wait_for("the point is too far")
    action.graph.publish_error = RuntimeError("nobody serves /drive_to_point")
    await action.press("ctrl+s")
    told = "Not sent: nobody serves /drive_to_point"
    await action.wait(lambda: told in [one.message for one in action.app._notifications])


MINE, THEIRS = "3f2a9c1e" + "0" * 24, "8d00b7f4" + "0" * 24
SEEN = (
    SeenGoal(ACTION, DRIVE, MINE, GoalStatus.SUCCEEDED, 63.0),
    SeenGoal(ACTION, DRIVE, THEIRS, GoalStatus.EXECUTING, 12.3, {"distance": 0.7}, 9),
    SeenGoal("/another", DRIVE, "7" * 32, GoalStatus.EXECUTING, 1.0),
)


async def test_a_goal_of_another_client_is_cancelled_only_after_asking(action: GraphStage) -> None:
    await action.press("ctrl+s")
    await action.wait_for("#1 ◌ sending 0.0 s own")
    update = action.graph.update
    assert update is not None
    await action.show(replace(update, seen_goals=SEEN))
    pane = action.screen.ask_pane
    assert pane is not None
    pane.asked_rows.choose(THEIRS)
    await action.press("f12")
    await action.wait_for("Cancel a goal of another client?")
    assert THEIRS in action.seen()
    await action.press("escape")
    assert action.graph.asked(CancelSeenGoal) == []
    await action.press("f12", "enter")
    await action.wait(lambda: action.graph.asked(CancelSeenGoal))
    assert action.graph.asked(CancelSeenGoal) == [(ACTION, THEIRS, "")]
    # What has ended is left alone, and Deck's own come before those of others.
    pane.asked_rows.choose(MINE)
    await action.press("f12")
    assert action.graph.asked(CancelGoal) == [(1,)]
    assert action.graph.asked(CancelSeenGoal) == [(ACTION, THEIRS, "")]
    # Nor can Deck forget what is not its own.
    action.screen.names.focus()
    await action.press("d")
    assert action.graph.asked(ForgetGoal) == []

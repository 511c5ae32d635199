"""Calling services and sending goals on the screen of the graph."""

from __future__ import annotations

from collections.abc import AsyncIterator
from concurrent.futures import Future
from contextlib import asynccontextmanager
from dataclasses import replace

import pytest
from textual.widgets import Input

from graph.data import CallResult, GoalStatus, SeenGoal
from tests.tui.graph_stage import GraphStage, opened
from tests.tui.recorded import RecordedGraph
from tests.tui.recorded_nodes import SERVICES, graph_update
from tests.tui.snapshots import Look
from tui.frame.key_bar import KeyBar
from tui.graph.places import GraphKind, GraphPlace

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
    assert service.graph.called == [(SERVICE, ADD, {"a": 30, "b": -10})]
    await service.wait_for("sum: 1")
    assert "a 30, b -10 → sum 1" in service.seen()


async def test_tab_leads_into_the_form_where_digits_and_enter_stay() -> None:
    async with opened() as stage:
        await stage.screen.go(GraphPlace(GraphKind.SERVICE, SERVICE))
        await stage.wait_for("✓ valid ")
        assert "tab Fill in" in footer(stage)
        await stage.press("tab")
        pane = stage.screen.ask_pane
        assert pane is not None
        assert stage.screen.focused is pane.form.editor
        assert "Fill in" not in footer(stage)
        await stage.press(*"1234567", "enter", "8")
        assert pane.form.text.startswith("1234567\n8")
        assert stage.app.screen is stage.screen
        assert stage.screen.history.here == GraphPlace(GraphKind.SERVICE, SERVICE)
        await stage.press("escape")
        assert stage.screen.is_in_list


async def test_tab_goes_on_from_the_form_to_the_time_out_and_from_a_list_to_its_detail() -> None:
    async with opened() as stage:
        await stage.press("tab")
        assert stage.screen.focused not in {None, stage.screen.names}
        await stage.press("escape")
        await stage.screen.go(GraphPlace(GraphKind.SERVICE, SERVICE))
        await stage.wait_for("✓ valid ")
        await stage.press("tab", "tab", "backspace", "9")
        assert timeout_field(stage).value == "9"


@pytest.mark.parametrize(("language", "words"), [("en", "tab Fill in"), ("ru", "tab Заполнить")])
@pytest.mark.parametrize(
    "place", [GraphPlace(GraphKind.SERVICE, SERVICE), GraphPlace(GraphKind.ACTION, ACTION)]
)
async def test_the_footer_of_a_small_terminal_says_where_tab_leads(
    language: str, words: str, place: GraphPlace
) -> None:
    async with opened(look=Look((80, 24), language)) as stage:
        await stage.screen.go(place)
        await stage.wait(lambda: stage.screen.ask_pane is not None and words in footer(stage))


def footer(stage: GraphStage) -> str:
    """Return the keys that are shown."""
    return str(stage.screen.query_one(KeyBar).render())


async def test_a_wrong_request_is_not_sent(service: GraphStage) -> None:
    fill(service, "a: much\n")
    await service.press("ctrl+s")
    assert service.graph.called == []
    assert "✗" in service.seen()


async def test_a_call_that_waits_freezes_nothing_and_can_be_given_up(service: GraphStage) -> None:
    service.graph.hold_calls = True
    await service.press("ctrl+s")
    await service.wait_for("Still waiting: 0 s of 5 s")
    assert "f12 stops waiting for it." in service.seen()
    assert "f12 Cancel" in service.seen()
    await service.press("escape")
    await service.press("left")
    assert "/ai_brain" in service.seen()
    await service.press("right", "x")
    await service.wait_for("given up")
    # Its time passes too, and still nobody is told that it has failed.
    late = time_is_over(service)
    late.set_result(CallResult(SERVICE, True, {"sum": 7}, "", 9.0))
    await service.wait_for("Late response after 9.0 s (time-out 5 s)")
    await service.wait_for("sum: 7")


def time_is_over(stage: GraphStage) -> Future[CallResult]:
    """Let the time of the newest call pass; the future is for what still comes of it."""
    late: Future[CallResult] = Future()
    why = "/set_head_position: no answer within 5 s"
    stage.graph.waiting[-1].set_result(CallResult(SERVICE, False, None, why, 5.0, late))
    return late


def timeout_field(stage: GraphStage) -> Input:
    return stage.screen.query_one("#call-timeout", Input)


async def test_the_time_out_is_chosen_below_the_form_and_each_service_keeps_its_own(
    service: GraphStage,
) -> None:
    service.graph.hold_calls = True
    assert timeout_field(service).value == "5"
    timeout_field(service).focus()
    await service.press("backspace", "3", "0", "ctrl+s")
    await service.wait_for("Still waiting: 0 s of 30 s")
    assert service.graph.waited_s == [30.0]
    await service.screen.go(GraphPlace(GraphKind.SERVICE, "/camera/set_parameters"))
    await service.wait_for("valid rcl_interfaces/srv/SetParameters")
    assert timeout_field(service).value == "5"
    await service.screen.go(GraphPlace(GraphKind.SERVICE, SERVICE))
    await service.wait_for("Still waiting: 0 s of 30 s")
    assert timeout_field(service).value == "30"


@pytest.mark.parametrize("typed", ["", "soon", "0", "-3", "nan", "1e9"])
async def test_a_time_out_that_is_none_is_told_and_nothing_is_called(
    service: GraphStage, typed: str
) -> None:
    timeout_field(service).value = typed
    await service.wait_for("✗ 0.1 to 3600 s")
    service.screen.names.focus()
    await service.press("ctrl+s")
    assert service.graph.called == []
    assert timeout_field(service).has_focus
    timeout_field(service).value = "0,5"
    await service.press("ctrl+s")
    assert service.graph.waited_s == [0.5]


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


async def test_a_service_that_leaves_after_the_time_out_is_told(service: GraphStage) -> None:
    service.graph.hold_calls = True
    await service.press("ctrl+s")
    await service.wait_for("Still waiting")
    late = time_is_over(service)
    await service.wait_for("no response yet")
    why = f"{SERVICE} has left the graph and has not answered"
    late.set_result(CallResult(SERVICE, False, None, why, 8.0))
    await service.wait_for(why)


async def test_a_call_that_fails_says_why(service: GraphStage) -> None:
    why = "no answer within 5 s"
    service.graph.answers[SERVICE] = CallResult(SERVICE, False, None, why, 5.0)
    await service.press("ctrl+s")
    await service.wait_for("the call failed")
    assert why in service.seen()
    assert "No response · 5000.0 ms" in service.seen()


async def test_calls_are_listed_and_an_older_answer_can_be_seen_again(service: GraphStage) -> None:
    await service.press("ctrl+s")
    await service.wait_for("Response in")
    service.graph.answers[SERVICE] = CallResult(SERVICE, True, {"sum": 0}, "", 0.2)
    await service.press("ctrl+s")
    await service.wait_for("sum: 0")
    pane = service.screen.ask_pane
    assert pane is not None
    pane.asked_rows.choose("1")
    await service.wait_for("sum: 1")


async def test_a_service_that_vanishes_is_told_and_not_called(service: GraphStage) -> None:
    rest = tuple(row for row in SERVICES if row.name != SERVICE)
    await service.show(graph_update(services=rest))
    assert "nobody serves it any more" in service.seen()
    await service.press("ctrl+s")
    assert service.graph.called == []


async def test_what_was_typed_is_there_when_one_comes_back(service: GraphStage) -> None:
    fill(service, "a: 5\nb: 6\n")
    await service.press("escape", "a")
    await service.choose("/camera/set_parameters")
    await service.wait_for("valid rcl_interfaces/srv/SetParameters")
    await service.choose(SERVICE)
    await service.wait_for("a: 5")


async def test_names_lead_to_the_type_and_to_the_server(service: GraphStage) -> None:
    await service.screen.go(GraphPlace(GraphKind.TYPE, ADD))
    await service.wait_for("response")
    assert "int64" in service.seen()
    await service.press("escape")
    assert service.screen.history.here == GraphPlace(GraphKind.SERVICE, SERVICE)


async def test_a_goal_is_sent_and_its_feedback_and_result_are_shown(action: GraphStage) -> None:
    fill(action, "x: 1.0\ny: 2.0\ntolerance: 0.1\n")
    await action.press("ctrl+s")
    await action.wait(lambda: action.graph.sent_goals)
    assert action.graph.sent_goals == [(ACTION, DRIVE, {"x": 1.0, "y": 2.0, "tolerance": 0.1})]
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


async def test_several_goals_are_listed_and_the_chosen_one_is_cancelled(action: GraphStage) -> None:
    await action.press("ctrl+s", "ctrl+s")
    await action.wait_for("#2")
    assert "#1" in action.seen()
    assert "f12 Cancel" in action.seen()
    await action.press("f12")
    assert action.graph.canceled_goals == [2]
    action.graph.change_goal(2, status=GoalStatus.CANCELED)
    await action.wait_for("○ canceled")
    await action.press("f12")
    assert action.graph.canceled_goals == [2, 1]


async def test_a_goal_is_forgotten(action: GraphStage) -> None:
    await action.press("ctrl+s")
    await action.wait_for("#1")
    await action.press("escape", "d")
    assert action.graph.forgotten_goals == [1]
    await action.wait_for("no goal has been sent yet")


async def test_a_goal_that_is_refused_says_why(action: GraphStage) -> None:
    await action.press("ctrl+s")
    await action.wait_for("#1")
    action.graph.change_goal(1, status=GoalStatus.REJECTED, error="the point is too far")
    await action.wait_for("the point is too far")
    action.graph.publish_error = RuntimeError("nobody serves /drive_to_point")
    await action.press("ctrl+s")
    told = "Not sent: nobody serves /drive_to_point"
    await action.wait(lambda: told in [one.message for one in action.app._notifications])


async def test_a_goal_that_was_just_sent_is_chosen_as_soon_as_it_is_listed(
    action: GraphStage, monkeypatch: pytest.MonkeyPatch
) -> None:
    await action.press("ctrl+s")
    await action.wait_for("#1 ◌ sending")
    pane = action.screen.ask_pane
    assert pane is not None
    number: Future[int] = Future()
    number.set_result(2)
    monkeypatch.setattr(action.graph, "send_goal", lambda *_goal: number)
    await action.press("ctrl+s")
    update = action.graph.update
    assert update is not None
    assert pane.asked_rows.chosen == "1"
    await action.show(replace(update, goals=(*update.goals, replace(update.goals[0], number=2))))
    await action.wait_for("#2 ◌ sending")
    assert pane.asked_rows.chosen == "2"
    # Once, and then whoever looks at another one is left alone.
    pane.asked_rows.choose("1")
    action.graph.change_goal(2, elapsed_s=1.5)
    await action.wait_for("1.5 s")
    assert pane.asked_rows.chosen == "1"


MINE, THEIRS = "3f2a9c1e" + "0" * 24, "8d00b7f4" + "0" * 24
SEEN = (
    SeenGoal(ACTION, DRIVE, MINE, GoalStatus.SUCCEEDED, 63.0),
    SeenGoal(ACTION, DRIVE, THEIRS, GoalStatus.EXECUTING, 12.3, {"distance": 0.7}, 9),
    SeenGoal("/another", DRIVE, "7" * 32, GoalStatus.EXECUTING, 1.0),
)


async def test_goals_of_other_clients_are_listed_with_id_state_age_and_feedback(
    action: GraphStage,
) -> None:
    assert action.graph.goals_watched == {ACTION}
    await action.show(graph_update(seen_goals=SEEN))
    await action.wait_for("8d00b7f4 ● executing 12.3 s other · feedback 9")
    await action.wait_for("3f2a9c1e ✓ succeeded 63.0 s other · feedback 0")
    await action.wait_for("distance: 0.7")
    assert "77777777" not in action.seen()
    # Nobody need look at them who looks at something else.
    await action.app.show_screen("topics")
    assert action.graph.goals_watched == set()
    await action.app.show_screen("graph")
    assert action.graph.goals_watched == {ACTION}


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
    assert action.graph.canceled_of_others == []
    await action.press("f12", "enter")
    await action.wait(lambda: action.graph.canceled_of_others)
    assert action.graph.canceled_of_others == [(ACTION, THEIRS)]
    # What has ended is left alone, and Deck's own come before those of others.
    pane.asked_rows.choose(MINE)
    await action.press("f12")
    assert action.graph.canceled_goals == [1]
    assert action.graph.canceled_of_others == [(ACTION, THEIRS)]
    # Nor can Deck forget what is not its own.
    action.screen.names.focus()
    await action.press("d")
    assert action.graph.forgotten_goals == []


async def test_the_newest_goal_of_others_is_meant_where_the_chosen_one_has_ended(
    action: GraphStage,
) -> None:
    await action.show(graph_update(seen_goals=SEEN[:1]))
    await action.wait_for("3f2a9c1e ✓ succeeded")
    assert "f12 Cancel" not in action.seen()
    await action.show(graph_update(seen_goals=SEEN))
    await action.wait_for("f12 Cancel")
    await action.press("f12")
    await action.wait_for("Cancel a goal of another client?")
    assert THEIRS in action.seen()


async def test_why_a_goal_of_another_client_was_not_cancelled_is_told(action: GraphStage) -> None:
    why = "the server refuses to cancel it"
    await action.show(graph_update(seen_goals=(replace(SEEN[1], error=why),)))
    await action.wait_for("8d00b7f4 ● executing · of another client")
    assert why in action.seen()


async def test_what_is_not_in_front_is_neither_sent_nor_forgotten(action: GraphStage) -> None:
    await action.press("ctrl+s")
    await action.wait_for("#1")
    await action.press("escape", "slash", *"x: 2")
    await action.wait_for("nothing matches the filter")
    assert "Send goal" not in action.seen()
    await action.press("ctrl+s")
    assert len(action.graph.sent_goals) == 1
    # What is under way can be ended from anywhere.
    assert "f12 Cancel" in action.seen()
    await action.press("f12")
    assert action.graph.canceled_goals == [1]
    action.screen.names.focus()
    await action.press("d")
    assert action.graph.forgotten_goals == []
    await action.press("escape")
    await action.wait_for("Send goal")
    await action.press("ctrl+s")
    assert len(action.graph.sent_goals) == 2


async def test_what_is_asked_belongs_to_its_place(action: GraphStage) -> None:
    await action.press("ctrl+s")
    await action.wait_for("#1")
    await action.press("escape", "left")
    await action.wait_for("not called yet")
    assert action.screen.history.kind is GraphKind.SERVICE


async def test_all_types_that_are_installed_can_be_looked_into(service: GraphStage) -> None:
    await service.press("escape", "right", "right")
    assert service.screen.history.kind is GraphKind.TYPE
    assert "geometry_msgs/msg/Twist" not in service.seen()
    await service.press("a")
    twist = "geometry_msgs/msg/Twist"
    await service.wait(
        lambda: twist in [one.name for one in service.screen.index.listed[GraphKind.TYPE]]
    )
    await service.choose("geometry_msgs/msg/Twist")
    await service.wait_for("geometry_msgs/Vector3")
    await service.press("enter", "right")
    await service.wait_for("float64 = 0.0")
    await service.press("enter")
    assert service.screen.history.here == GraphPlace(GraphKind.TYPE, "geometry_msgs/msg/Vector3")
    await service.press("escape")
    assert service.screen.history.here == GraphPlace(GraphKind.TYPE, "geometry_msgs/msg/Twist")

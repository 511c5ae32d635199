"""Parameters on the screen of the graph: read, changed, refused, saved and loaded."""

from __future__ import annotations

from collections.abc import AsyncIterator
from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from textual.widgets import Input

from graph.data import GraphUpdate, ParametersResult, Sample
from tests.tui.graph_room import Room, opened
from tests.tui.recorded_nodes import graph_update
from tests.tui.snapshots import settle
from tui.graph.parameter_dialog import ParameterDialog
from tui.graph.parameters import PARAMETER_EVENTS

NODE = "/sonar_front"


@pytest.fixture
async def room() -> AsyncIterator[Room]:
    async with opened() as opened_room:
        await opened_room.choose(NODE)
        yield opened_room


async def typed(room: Room, text: str) -> None:
    room.app.screen.query_one(Input).value = text
    await room.press("enter")


async def test_they_are_read_when_asked_and_not_before(room: Room) -> None:
    assert room.graph.asked_parameters == []
    await room.press("E")
    await room.wait_for("5 parameters · read in 10 ms")
    assert room.graph.asked_parameters == [NODE]
    assert "0.1…50, above 0" in room.seen()
    assert "⊘ sonar_front" in room.seen()
    await room.press("E")
    assert "5 parameters" not in room.seen()


async def test_those_of_a_node_that_is_not_in_front_are_not_offered(room: Room) -> None:
    await room.press("E")
    await room.wait_for("5 parameters")
    await room.press("slash", "q", "q")
    await room.wait_for("nothing fits the filter")
    assert "W Save" not in room.seen()
    room.screen.names.focus()
    await room.press("W", "O", "E")
    assert room.app.screen is room.screen
    assert room.graph.asked_parameters == [NODE]
    await room.press("escape")
    await room.wait_for("W Save")


async def test_another_value_is_set_and_read_back(room: Room) -> None:
    await room.press("E", "down", "enter")
    assert "Allowed: 0.1…50, above 0" in room.seen()
    await typed(room, "2.5")
    await room.wait(lambda: room.app.screen is room.screen)
    assert room.graph.set_to == [(NODE, {"rate": "2.5"})]
    await room.wait(lambda: room.graph.asked_parameters == [NODE, NODE])


def shown(room: Room) -> GraphUpdate:
    """The graph as it is now."""
    assert room.graph.update is not None
    return room.graph.update


def changed(room: Room, node: str) -> GraphUpdate:
    """The graph in which a node tells that `rate` was set from outside."""
    value: dict[str, Any] = {"node": node, "changed_parameters": [{"name": "rate"}]}
    event = Sample(PARAMETER_EVENTS, "rcl_interfaces/msg/ParameterEvent", 0.0, 0.0, 99, value)
    return replace(shown(room), samples={PARAMETER_EVENTS: (event,)})


async def test_a_change_from_outside_is_read_at_once(room: Room) -> None:
    """`ros2 param set` in another window; what other nodes change asks this one nothing."""
    assert PARAMETER_EVENTS in room.graph.followed
    await room.press("E")
    await room.wait_for("5 parameters")
    await room.show(changed(room, "/camera"))
    assert room.graph.asked_parameters == [NODE]
    await room.show(changed(room, NODE))
    assert room.graph.asked_parameters == [NODE, NODE]
    await room.press("E")
    await room.show(changed(room, NODE))
    assert room.graph.asked_parameters == [NODE, NODE], "they are not shown"


def started(room: Room, *processes: int) -> GraphUpdate:
    """The graph in which the node lives in these processes, in none if there are none."""
    others = [row for row in shown(room).nodes if row.name != NODE]
    (node,) = (row for row in graph_update().nodes if row.name == NODE)
    nodes = (*others, replace(node, processes=processes)) if processes else tuple(others)
    return replace(shown(room), nodes=nodes)


async def test_a_node_that_was_started_again_is_read_anew(room: Room) -> None:
    """It has its first values again, and who listens now may not have heard it tell so."""
    await room.show(started(room, 7))
    await room.press("E")
    await room.wait_for("5 parameters")
    await room.show(started(room))
    await room.show(started(room, 7))
    assert room.graph.asked_parameters == [NODE]
    await room.show(started(room))
    await room.show(started(room, 8))
    await room.wait(lambda: room.graph.asked_parameters == [NODE, NODE])


async def test_changes_faster_than_the_answers_are_read_once_more(
    room: Room, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One that asked anew at each of them would never see an answer."""
    asked: list[Future[ParametersResult]] = []

    def ask(_node: str) -> Future[ParametersResult]:
        asked.append(Future())
        return asked[-1]

    monkeypatch.setattr(room.graph, "parameters", ask)
    await room.press("E")
    for _round in range(3):
        await room.show(changed(room, NODE))
    assert len(asked) == 1
    asked[0].set_result(ParametersResult(NODE, (), "the first answer"))
    await room.wait_for("the first answer")
    await room.wait(lambda: len(asked) == 2)
    asked[1].set_result(ParametersResult(NODE, (), "the second answer"))
    await room.wait_for("the second answer")
    await settle(room.pilot)
    assert len(asked) == 2


async def test_a_refusal_keeps_the_dialog_open_and_says_why(room: Room) -> None:
    room.graph.refusals["rate"] = "outside of 0.1 to 50"
    await room.press("E", "down", "enter")
    await typed(room, "99")
    await room.wait_for("Refused: outside of 0.1 to 50")
    await room.press("escape")
    assert room.app.screen is room.screen


async def test_a_name_that_the_title_of_the_dialog_cuts_stands_whole_in_it(room: Room) -> None:
    await room.press("E", "down", "enter")
    dialog = room.app.screen
    assert isinstance(dialog, ParameterDialog)
    assert NODE not in dialog.words().plain
    row = replace(dialog._row, name="a_namespace_of_parameters." * 3 + "END")
    long = ParameterDialog(NODE, row, dialog._apply)
    assert long.words().plain.startswith(f"{NODE} · {row.name}\n")


async def test_what_can_only_be_read_is_not_offered_for_change(room: Room) -> None:
    await room.press("E", "enter")
    assert isinstance(room.app.screen, ParameterDialog)
    assert room.app.screen.query_one(Input).disabled
    assert "It can only be read" in room.seen()
    await room.press("escape")
    await room.wait(lambda: room.app.screen is room.screen)


async def test_a_node_that_does_not_answer_freezes_nothing(
    room: Room, monkeypatch: pytest.MonkeyPatch
) -> None:
    future: Future[ParametersResult] = Future()
    monkeypatch.setattr(room.graph, "parameters", lambda _node: future)
    await room.press("E")
    assert "the node is being asked" in room.seen()
    assert "asked, no answer for 0 s" in room.seen()
    future.set_result(ParametersResult(NODE, (), "no answer within 5 s"))
    await room.wait_for("no answer within 5 s")


async def test_an_answer_that_comes_late_is_not_taken_for_another_node(
    room: Room, monkeypatch: pytest.MonkeyPatch
) -> None:
    future: Future[ParametersResult] = Future()
    monkeypatch.setattr(room.graph, "parameters", lambda _node: future)
    await room.press("E", "E")
    monkeypatch.undo()
    await room.choose("/camera")
    await room.press("E")
    await room.wait_for("5 parameters")
    future.set_result(ParametersResult(NODE, (), "too late"))
    await settle(room.pilot)
    assert "too late" not in room.seen()


async def test_they_are_saved_and_loaded_as_yaml(room: Room, tmp_path: Path) -> None:
    path = tmp_path / "sonar.yaml"
    await room.press("E", "W")
    await typed(room, str(path))
    await room.wait(lambda: room.app.screen is room.screen)
    assert "rate: 1.0" in path.read_text()
    path.write_text(path.read_text().replace("rate: 1.0", "rate: 3.0"))
    await room.press("O")
    await typed(room, str(path))
    await room.wait(lambda: room.graph.set_to)
    ((node, values),) = room.graph.set_to
    assert node == NODE
    assert values["rate"] == 3.0
    assert "frame_id" not in values


async def test_a_file_that_is_there_is_written_over_only_when_enter_is_pressed_again(
    room: Room, tmp_path: Path
) -> None:
    path = tmp_path / "notes.yaml"
    path.write_text("precious")
    await room.press("E", "W")
    await typed(room, str(path))
    await room.wait_for("Enter again overwrites it")
    assert path.read_text() == "precious"
    await room.press("enter")
    await room.wait(lambda: room.app.screen is room.screen)
    assert "rate: 1.0" in path.read_text()


async def test_a_file_that_is_wrong_is_told_with_its_line(
    room: Room, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Short names: a long one is broken into two lines anywhere.
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.yaml").write_text("/sonar_front:\n  ros__parameters:\n    rate: [1, 2\n")
    await room.press("E", "O")
    await typed(room, "bad.yaml")
    await room.wait_for("bad.yaml:3:")
    await typed(room, "none.yaml")
    await room.wait_for("No such file")
    assert room.graph.set_to == []

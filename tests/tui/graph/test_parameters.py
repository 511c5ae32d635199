"""Parameters on the screen of the graph: read, changed, refused, saved and loaded."""

from __future__ import annotations

from collections.abc import AsyncIterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from textual.app import App, ComposeResult
from textual.events import Paste
from textual.widgets import Input

from graph.data import GraphUpdate, Sample
from graph.observer.requests import ReadParameters, SetParameters
from tests.hostile_text import EVIL
from tests.tui.graph_stage import GraphStage, opened
from text.plain import is_plain, plain
from text.yaml_scalars import in_quotes, unquoted
from tui.graph.parameters import PARAMETER_EVENTS, meant
from tui.graph.parameters import typed as as_typed
from tui.widgets.field import Field

NODE = "/sonar_front"


@pytest.fixture
async def stage() -> AsyncIterator[GraphStage]:
    async with opened() as opened_room:
        await opened_room.choose(NODE)
        yield opened_room


async def typed(stage: GraphStage, text: str) -> None:
    stage.app.screen.query_one(Input).value = text
    await stage.press("enter")


async def test_they_are_read_when_asked_and_not_before(stage: GraphStage) -> None:
    assert stage.graph.asked(ReadParameters) == []
    await stage.press("E")
    await stage.wait_for("5 parameters · read in 10 ms")
    assert [node for node, _within_s in stage.graph.asked(ReadParameters)] == [NODE]
    assert "0.1…50, above 0" in stage.seen()
    assert "⊘ sonar_front" in stage.seen()
    await stage.press("E")
    assert "5 parameters" not in stage.seen()


async def test_another_value_is_set_and_read_back(stage: GraphStage) -> None:
    await stage.press("E", "down", "enter")
    assert "Allowed: 0.1…50, above 0" in stage.seen()
    await typed(stage, "2.5")
    await stage.wait(lambda: stage.app.screen is stage.screen)
    assert stage.graph.asked(SetParameters)[0][:2] == (NODE, {"rate": "2.5"})
    await stage.wait(lambda: len(stage.graph.asked(ReadParameters)) == 2)


def shown(stage: GraphStage) -> GraphUpdate:
    assert stage.graph.update is not None
    return stage.graph.update


def changed(stage: GraphStage, node: str) -> GraphUpdate:
    """The graph in which a node tells that `rate` was set from outside."""
    value: dict[str, Any] = {"node": node, "changed_parameters": [{"name": "rate"}]}
    event = Sample(PARAMETER_EVENTS, "rcl_interfaces/msg/ParameterEvent", 0.0, 0.0, 99, value)
    return replace(shown(stage), samples={PARAMETER_EVENTS: (event,)})


async def test_a_change_from_outside_is_read_at_once(stage: GraphStage) -> None:
    """`ros2 param set` in another window; what other nodes change asks this one nothing."""
    assert PARAMETER_EVENTS in stage.graph.wanted.followed
    await stage.press("E")
    await stage.wait_for("5 parameters")
    await stage.show(changed(stage, "/camera"))
    assert [node for node, _within_s in stage.graph.asked(ReadParameters)] == [NODE]
    await stage.show(changed(stage, NODE))
    assert len(stage.graph.asked(ReadParameters)) == 2
    await stage.press("E")
    await stage.show(changed(stage, NODE))
    assert len(stage.graph.asked(ReadParameters)) == 2, "they are not shown"


async def test_a_refusal_keeps_the_dialog_open_and_says_why(stage: GraphStage) -> None:
    stage.graph.refusals["rate"] = "outside of 0.1 to 50"
    await stage.press("E", "down", "enter")
    await typed(stage, "99")
    await stage.wait_for("Refused: outside of 0.1 to 50")
    await stage.press("escape")
    assert stage.app.screen is stage.screen


async def test_they_are_saved_and_loaded_as_yaml(stage: GraphStage, tmp_path: Path) -> None:
    path = tmp_path / "sonar.yaml"
    await stage.press("E", "W")
    await typed(stage, str(path))
    await stage.wait(lambda: stage.app.screen is stage.screen)
    assert "rate: 1.0" in path.read_text()
    path.write_text(path.read_text().replace("rate: 1.0", "rate: 3.0"))
    await stage.press("O")
    await typed(stage, str(path))
    await stage.wait(lambda: stage.graph.asked(SetParameters))
    ((node, values, _within_s),) = stage.graph.asked(SetParameters)
    assert node == NODE
    assert values["rate"] == 3.0
    assert "frame_id" not in values


async def test_a_file_that_is_wrong_is_told_with_its_line(
    stage: GraphStage, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Short names: a long one is broken into two lines anywhere.
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.yaml").write_text("/sonar_front:\n  ros__parameters:\n    rate: [1, 2\n")
    await stage.press("E", "O")
    await typed(stage, "bad.yaml")
    await stage.wait_for("bad.yaml:3:")
    await typed(stage, "none.yaml")
    await stage.wait_for("No such file")
    assert stage.graph.asked(SetParameters) == []


class FieldApp(App[None]):
    """One field."""

    def compose(self) -> ComposeResult:
        yield Field(EVIL)


async def test_what_is_pasted_is_made_visible_and_that_is_the_value() -> None:
    app = FieldApp()
    async with app.run_test() as pilot:
        field = app.query_one(Field)
        assert field.value == plain(EVIL)
        field.clear()
        field.post_message(Paste("/dri\u200bve\x1b]52;c;QQ==\x07\u202e"))
        await pilot.pause()
        assert field.value == "/dri\ufffdve␛]52;c;QQ==␇\ufffd"
        assert field.cursor_position == len(field.value)


@given(st.text(st.characters(exclude_categories=["Cs"]), max_size=80))
def test_a_text_typed_as_it_is_shown_is_that_text(text: str) -> None:
    assert is_plain(as_typed(text))
    assert meant(as_typed(text)) == text
    assert unquoted(in_quotes(text)) == text

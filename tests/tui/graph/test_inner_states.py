"""Lifecycle, log level and components of a node, in its detail: shown, and changed by a key."""

from __future__ import annotations

from collections.abc import AsyncIterator
from dataclasses import replace

import pytest

from graph.inner_states import LifecycleRow, TransitionResult
from tests.tui.graph_stage import GraphStage, opened
from tests.tui.recorded import RecordedGraph
from tests.tui.recorded_inner import managed_update
from tui.dialogs.choice import ChoiceScreen
from tui.frame.key_bar import KeyBar
from tui.graph.places import GraphKind, GraphPlace

pytestmark = pytest.mark.nightly

CAMERA = GraphPlace(GraphKind.NODE, "/camera")


@pytest.fixture
async def stage() -> AsyncIterator[GraphStage]:
    async with opened(RecordedGraph(update=managed_update())) as opened_room:
        yield opened_room


async def until_told(stage: GraphStage, words: str) -> None:
    await stage.wait(lambda: any(words in one.message for one in stage.app._notifications))


def footer(stage: GraphStage) -> str:
    return str(stage.app.screen.query_one(KeyBar).render())


async def test_a_state_is_followed_and_only_what_is_possible_is_offered(stage: GraphStage) -> None:
    await stage.choose("/safety_stop")
    assert "lifecycle" not in stage.seen()
    assert "Lifecycle" not in footer(stage)
    await stage.press("J")
    assert not isinstance(stage.app.screen, ChoiceScreen)
    await stage.choose("/camera")
    await stage.wait_for("lifecycle: inactive · can cleanup, activate, shutdown")
    assert "Lifecycle" in footer(stage)
    await stage.show(replace(managed_update(), lifecycles=(LifecycleRow("/camera", "activating"),)))
    await stage.wait_for("lifecycle: activating")
    await stage.wait(lambda: "Lifecycle" not in footer(stage))
    hanging = LifecycleRow("/camera", "activating", (), "/camera does not answer within 5 s")
    await stage.show(replace(managed_update(), lifecycles=(hanging,)))
    await stage.wait_for("lifecycle: activating · /camera does not answer within 5 s")


async def test_a_transition_is_made_by_a_key_and_its_outcome_is_told(stage: GraphStage) -> None:
    await stage.choose("/camera")
    await stage.press("J")
    await stage.wait(lambda: isinstance(stage.app.screen, ChoiceScreen))
    await stage.press("down", "enter")
    await until_told(stage, "/camera is active now")
    assert stage.graph.inner.changes == [("/camera", "activate")]
    why = "/camera refuses to cleanup and stays inactive; its log may say why"
    stage.graph.inner.outcomes = {"cleanup": TransitionResult("/camera", "cleanup", "", why)}
    await stage.press("J", "enter")
    await until_told(stage, "/camera refuses to cleanup and stays inactive")


async def test_a_log_level_is_set_or_it_is_said_how_to_allow_that(stage: GraphStage) -> None:
    await stage.choose("/camera")
    await stage.press("K")
    await stage.wait(lambda: isinstance(stage.app.screen, ChoiceScreen))
    await stage.press("up", "enter")
    await until_told(stage, "/camera logs from debug on")
    assert stage.graph.inner.levels == {"/camera": "debug"}
    stage.graph.inner.refusals["/audio"] = "/audio does not let others change its log level"
    await stage.choose("/audio")
    await stage.press("K")
    await until_told(stage, "/audio does not let others change its log level")


async def test_a_link_leads_from_a_container_to_its_component_and_back(stage: GraphStage) -> None:
    await stage.choose("/perception")
    await stage.wait_for("/debayer component 2")
    await stage.press("enter", "enter")
    await stage.wait(lambda: stage.screen.history.here == CAMERA)
    await stage.wait_for("Is in the container")

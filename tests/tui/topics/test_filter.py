"""Only messages for which an expression holds, on the screen of topics."""

from __future__ import annotations

from collections.abc import AsyncIterator

import pytest
from textual.widgets import Static

from graph.data import GraphUpdate
from tests.tui.recorded import lesson_update, sample
from tests.tui.topics_stage import SONAR, TopicsStage, opened


def sonar(*metres: float) -> GraphUpdate:
    """So many messages of the sonar in one update."""
    values = tuple(sample(SONAR, "std_msgs/msg/Float32", {"data": each}) for each in metres)
    return lesson_update(samples={SONAR: values})


async def only_if(stage: TopicsStage, expression: str) -> None:
    """Choose the sonar, and let only messages through for which this holds."""
    await stage.choose(SONAR)
    await stage.pilot.press("f")
    field = stage.screen.detail.filter.field
    assert field.has_focus
    field.value = expression
    await stage.pilot.pause()
    await stage.pilot.pause()


def filter_line(stage: TopicsStage) -> str:
    """What is said beside the expression."""
    return str(stage.screen.query_one(".filter-told", Static).content)


@pytest.fixture
async def stage() -> AsyncIterator[TopicsStage]:
    async with opened() as stage:
        yield stage


async def test_only_messages_are_shown_for_which_the_expression_holds(stage: TopicsStage) -> None:
    await only_if(stage, "m.data > 0.5")
    # Each message is looked at, not the newest of an update alone.
    assert SONAR in stage.graph.followed
    await stage.show(sonar(0.7, 0.2, 0.3))
    assert "0.7" in stage.echo()
    assert filter_line(stage) == "1 of 3 messages"
    await stage.show(sonar(0.1))
    assert "0.7" in stage.echo()
    await stage.show(sonar(0.9))
    assert "0.9" in stage.echo()
    assert filter_line(stage) == "2 of 5 messages"


async def test_an_expression_that_is_wrong_names_the_place_and_lets_nothing_through(
    stage: TopicsStage,
) -> None:
    await stage.choose(SONAR)
    await only_if(stage, "m.data > 0.5 and data")
    told = "✗ column 18: data: the message is called m: write m.data"
    assert filter_line(stage) == told
    await stage.show(sonar(0.8))
    assert filter_line(stage) == told
    assert "the expression is wrong" in stage.echo()


async def test_a_field_that_is_missing_is_told_once_and_counted(stage: TopicsStage) -> None:
    await only_if(stage, "m.dat > 0.5")
    await stage.show(sonar(0.8, 0.9))
    await stage.show(sonar(0.8))
    told = "0 of 3 messages · ✗ column 1: m.dat: no such field; did you mean data? (×3)"
    assert filter_line(stage) == told
    assert not stage.app._notifications

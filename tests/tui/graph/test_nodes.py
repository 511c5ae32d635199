"""The screen of the graph: nodes, links between them, and what is said where nothing is."""

from __future__ import annotations

from collections.abc import AsyncIterator

import pytest

from graph.data import GraphUpdate
from tests.tui.graph_stage import GraphStage, opened
from tests.tui.recorded_nodes import NODE_ROWS, graph_update
from tui.graph.places import GraphKind, GraphPlace
from tui.topics.screen import TopicsScreen


@pytest.fixture
async def stage() -> AsyncIterator[GraphStage]:
    async with opened() as opened_room:
        yield opened_room


async def test_a_node_tells_with_whom_it_talks_and_which_process_it_is(stage: GraphStage) -> None:
    await stage.choose("/safety_stop")
    seen = " ".join(stage.seen().split())
    assert "● ready · process 4205 · CPU 2 % · 22 MB" in seen
    assert "/drive_safe → electronic_differential" in seen
    assert "/sensor/sonar_front ← sonar_front" in seen
    assert "/emergency_stop nobody" in seen
    assert "parameter_events" not in seen


async def test_what_ros_needs_is_hidden_until_it_is_asked_for(stage: GraphStage) -> None:
    await stage.press("right")
    assert stage.screen.history.kind is GraphKind.SERVICE
    assert "/camera/set_parameters" not in stage.seen()
    await stage.press("a")
    assert "/camera/set_parameters" in stage.seen()
    await stage.press("left", "a")
    assert "/rosout" not in stage.seen()


async def test_a_filter_narrows_down_as_one_types_and_escape_ends_it(stage: GraphStage) -> None:
    await stage.press("slash", *"sonar")
    assert "1 of 10" in stage.seen()
    assert stage.screen.names.chosen_name == "/sonar_front"
    await stage.press("enter", "escape")
    assert "10 of 10" in stage.seen()
    await stage.press("slash", *"zzz")
    assert "nothing matches the filter" in stage.seen()


async def test_enter_on_a_topic_goes_to_the_screen_of_topics(stage: GraphStage) -> None:
    await stage.choose("/sonar_front")
    await stage.press("enter", "enter")
    await stage.wait(lambda: isinstance(stage.app.screen, TopicsScreen))
    topics = stage.app.screen
    assert isinstance(topics, TopicsScreen)
    await stage.wait(lambda: topics.table.chosen == "/sensor/sonar_front")
    await stage.press("5")
    assert stage.app.screen is stage.screen
    assert stage.screen.history.here == GraphPlace(GraphKind.NODE, "/sonar_front")


async def test_a_chosen_node_that_vanishes_stays_and_says_so(stage: GraphStage) -> None:
    await stage.choose("/camera")
    rest = tuple(row for row in NODE_ROWS if row.name != "/camera")
    await stage.show(graph_update(nodes=rest))
    assert stage.screen.names.chosen_name == "/camera"
    assert "this node has left the graph" in stage.seen()
    assert "/camera (gone)" in stage.seen()
    assert "/camera/color/image_raw" in stage.seen()
    await stage.show(graph_update())
    assert "this node has left the graph" not in stage.seen()


async def test_without_ros_it_says_why(stage: GraphStage) -> None:
    await stage.show(GraphUpdate(0.0, error="rclpy is missing: source ROS 2"))
    assert "/ai_brain (gone)" in stage.seen()
    stage.screen.history.forget()
    await stage.show(GraphUpdate(1.0, error="rclpy is missing: source ROS 2"))
    assert "rclpy is missing: source ROS 2" in stage.seen()

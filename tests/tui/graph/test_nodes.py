"""The screen of the graph: nodes, links between them, and what is said where nothing is."""

from __future__ import annotations

from collections.abc import AsyncIterator
from dataclasses import replace

import pytest

from graph.data import GraphUpdate, NodeRow
from tests.tui.graph_room import Room, opened
from tests.tui.recorded_nodes import NODE_ROWS, graph_update
from tui.graph.places import GraphKind, GraphPlace
from tui.topics.screen import TopicsScreen


@pytest.fixture
async def room() -> AsyncIterator[Room]:
    async with opened() as opened_room:
        yield opened_room


async def test_a_node_tells_with_whom_it_talks_and_which_process_it_is(room: Room) -> None:
    await room.choose("/safety_stop")
    seen = " ".join(room.seen().split())
    assert "● ready · process 4205 · CPU 2 % · 22 MB" in seen
    assert "/drive_safe → electronic_differential" in seen
    assert "/sensor/sonar_front ← sonar_front" in seen
    assert "/emergency_stop nobody" in seen
    assert "parameter_events" not in seen


async def test_a_node_of_somebody_else_is_said_to_be_one(room: Room) -> None:
    await room.choose("/lesson_helper")
    assert "not started by Deck" in room.seen()
    assert "Sends goals to" in room.seen()


async def test_what_ros_needs_is_hidden_until_it_is_asked_for(room: Room) -> None:
    await room.press("right")
    assert room.screen.history.kind is GraphKind.SERVICE
    assert "/camera/set_parameters" not in room.seen()
    await room.press("a")
    assert "/camera/set_parameters" in room.seen()
    await room.press("left", "a")
    assert "/rosout" not in room.seen()


async def test_a_filter_narrows_down_as_one_types_and_escape_ends_it(room: Room) -> None:
    await room.press("slash", *"sonar")
    assert "1 of 10" in room.seen()
    assert room.screen.names.chosen_name == "/sonar_front"
    await room.press("enter", "escape")
    assert "10 of 10" in room.seen()
    await room.press("slash", *"zzz")
    assert "nothing fits the filter" in room.seen()


async def test_enter_follows_a_link_to_a_service_and_escape_goes_back(room: Room) -> None:
    await room.choose("/head_controller")
    await room.screen.go(GraphPlace(GraphKind.SERVICE, "/set_head_position"))
    await room.pilot.pause()
    assert room.screen.names.chosen_name == "/set_head_position"
    await room.press("escape")
    assert room.screen.history.here == GraphPlace(GraphKind.NODE, "/head_controller")


async def test_enter_on_a_topic_goes_to_the_screen_of_topics(room: Room) -> None:
    await room.choose("/sonar_front")
    await room.press("enter", "enter")
    await room.wait(lambda: isinstance(room.app.screen, TopicsScreen))
    topics = room.app.screen
    assert isinstance(topics, TopicsScreen)
    await room.wait(lambda: topics.table.chosen == "/sensor/sonar_front")
    await room.press("5")
    assert room.app.screen is room.screen
    assert room.screen.history.here == GraphPlace(GraphKind.NODE, "/sonar_front")


async def test_a_topic_of_ros_itself_is_shown_though_topics_hides_it(room: Room) -> None:
    await room.screen.go(GraphPlace(GraphKind.TOPIC, "/rosout"))
    topics = room.app.screen
    assert isinstance(topics, TopicsScreen)
    await room.wait(lambda: topics.table.chosen == "/rosout")


async def test_a_chosen_node_that_vanishes_stays_and_says_so(room: Room) -> None:
    await room.choose("/camera")
    rest = tuple(row for row in NODE_ROWS if row.name != "/camera")
    await room.show(graph_update(nodes=rest))
    assert room.screen.names.chosen_name == "/camera"
    assert "this node has left the graph" in room.seen()
    assert "/camera (gone)" in room.seen()
    assert "/camera/color/image_raw" in room.seen()
    await room.show(graph_update())
    assert "this node has left the graph" not in room.seen()


async def test_a_node_that_does_nothing_is_said_to(room: Room) -> None:
    await room.show(graph_update(nodes=(NodeRow("/idle"),)))
    await room.choose("/idle")
    assert "it talks to nobody" in room.seen()


async def test_without_ros_it_says_why(room: Room) -> None:
    await room.show(GraphUpdate(0.0, error="rclpy is missing: source ROS 2"))
    assert "/ai_brain (gone)" in room.seen()
    room.screen.history.forget()
    await room.show(GraphUpdate(1.0, error="rclpy is missing: source ROS 2"))
    assert "rclpy is missing: source ROS 2" in room.seen()


async def test_an_empty_domain_is_told_for_every_kind(room: Room) -> None:
    room.screen.history.forget()
    await room.show(GraphUpdate(0.0))
    assert "no node in this domain" in room.seen()
    for words in ("nobody serves a service", "nobody serves an action", "no type is in use"):
        await room.press("right")
        assert words in room.seen()


async def test_hostile_names_are_shown_as_they_are(room: Room) -> None:
    evil = replace(NODE_ROWS[0], name="/\x1b[2J[red]", publishes=("/\x1b]0;x\x07[/]",))
    await room.show(graph_update(nodes=(evil,)))
    await room.choose(evil.name)
    assert "\x1b" not in room.seen()
    assert "/␛[2J[red]" in room.seen()


async def test_space_stops_the_robot_from_the_list(room: Room) -> None:
    await room.press("space")
    assert room.app.emergency.state.engaged

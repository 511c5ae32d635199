"""The graph drawn: what the drawing shows, and how one walks on it."""

from __future__ import annotations

from collections.abc import AsyncIterator

import pytest
from textual.events import Key

from graph.data import GraphUpdate, NodeRow
from tests.tui.graph_stage import GraphStage, opened
from tests.tui.recorded_nodes import NODE_ROWS, graph_update
from tui.graph.map_drawing import MapDrawing, drawing
from tui.graph.neighbours import neighbours, node_called
from tui.graph.places import GraphKind, GraphPlace

pytestmark = pytest.mark.nightly

BRAIN = """
/audio/mic_raw ──────────────┐                ┌▶ /ai_command
  audio                      │                │    ai_driver
/camera/color/image_raw ─────┤  ┌───────────┐ ├▶ /audio/speaker_raw
  camera                     ├─▶│ /ai_brain │─┤    audio
/sensor/sonar_front ─────────┘  └───────────┘ └▶ /set_head_position()
  sonar_front                                      head_controller
"""


@pytest.fixture
async def stage() -> AsyncIterator[GraphStage]:
    async with opened() as opened_room:
        await opened_room.choose("/safety_stop")
        await opened_room.press("M")
        yield opened_room


def drawn(name: str, width: int, height: int, update: GraphUpdate | None = None) -> MapDrawing:
    update = update or graph_update()
    node = node_called(update, name)
    assert node is not None
    return drawing(name, neighbours(update, node), width, height)


async def held(stage: GraphStage, key: str, times: int, place: GraphPlace) -> None:
    """Press a key as one that is held down, and wait for where that leads.

    A busy machine takes a minute for sixty keys if each is waited for.
    """
    for _press in range(times):
        stage.app.post_message(Key(key, None))
    await stage.wait(lambda: stage.screen.map.here == place)
    await stage.pilot.pause()


def text(made: MapDrawing, width: int) -> str:
    rows = [[" "] * width for _row in range(made.height)]
    for piece in made.pieces:
        for at, character in enumerate(piece.text, piece.x):
            assert rows[piece.row][at] == " ", f"{piece} lies on another piece"
            rows[piece.row][at] = character
    return "\n".join("".join(row).rstrip() for row in rows).strip("\n")


def test_a_node_stands_between_what_it_hears_and_what_it_says() -> None:
    assert text(drawn("/ai_brain", 78, 6), 78).splitlines() == BRAIN.strip("\n").splitlines()


@pytest.mark.parametrize("width", [40, 78, 118, 198])
@pytest.mark.parametrize("height", [3, 21, 57])
@pytest.mark.parametrize("row", NODE_ROWS, ids=lambda row: row.name)
def test_no_piece_lies_on_another_or_outside(row: NodeRow, width: int, height: int) -> None:
    made = drawn(row.name, width, height)
    text(made, width)
    assert all(0 <= piece.row < made.height for piece in made.pieces)


def test_every_neighbour_can_be_reached() -> None:
    made = drawn("/safety_stop", 78, 21)
    left, centre, right = ([stop.place.name for stop in stops] for stops in made.stops)
    assert left == [
        "/drive", "/ai_driver", "/drive_to_point", "/emergency_stop", "/sensor/sonar_front",
        "/sonar_front",
    ]  # fmt: skip
    assert centre == ["/safety_stop"]
    assert right == ["/drive_safe", "/electronic_differential", "/safety_state"]


async def test_arrows_walk_and_enter_goes_on_from_there(stage: GraphStage) -> None:
    assert stage.screen.map.here == GraphPlace(GraphKind.NODE, "/safety_stop")
    await stage.press("right", "up", "up", "up", "down")
    assert stage.screen.map.here == GraphPlace(GraphKind.NODE, "/electronic_differential")
    await stage.press("enter")
    assert stage.screen.map.here == GraphPlace(GraphKind.NODE, "/electronic_differential")
    assert "/wheel_commands" in stage.seen()
    await stage.press("escape")
    assert stage.screen.map.here == GraphPlace(GraphKind.NODE, "/safety_stop")


async def test_the_edge_is_not_walked_over(stage: GraphStage) -> None:
    await stage.press("left", "left", "left")
    for key, times, edge in (
        ("up", 10, GraphPlace(GraphKind.TOPIC, "/drive")),
        ("down", 30, GraphPlace(GraphKind.NODE, "/sonar_front")),
    ):
        await held(stage, key, times, edge)
        await stage.press(key)
        assert stage.screen.map.here == edge


async def test_enter_on_a_service_goes_to_its_form(stage: GraphStage) -> None:
    await stage.screen.go(GraphPlace(GraphKind.NODE, "/head_controller"))
    await stage.pilot.pause()
    await stage.press("left", *("up",) * 5, "enter")
    assert stage.screen.history.here == GraphPlace(GraphKind.SERVICE, "/set_head_position")
    assert not stage.screen.draws
    await stage.wait_for("valid example_interfaces/srv/AddTwoInts")


async def test_a_node_that_vanishes_is_said_to_have_left(stage: GraphStage) -> None:
    rest = tuple(row for row in NODE_ROWS if row.name != "/safety_stop")
    await stage.show(graph_update(nodes=rest))
    assert "this node has left the graph" in stage.seen()
    await stage.show(graph_update())
    assert "┌" in stage.seen()


async def test_without_a_node_it_says_so(stage: GraphStage) -> None:
    await stage.press("M")
    stage.screen.history.forget()
    await stage.show(GraphUpdate(0.0))
    await stage.press("M")
    assert "no node to draw" in stage.seen()
    await stage.press("M")
    assert "no node in this domain" in stage.seen()


async def test_more_neighbours_than_rows_are_scrolled(stage: GraphStage) -> None:
    hub = NodeRow("/hub", publishes=tuple(f"/topic_{n:02}" for n in range(60)))
    await stage.show(graph_update(nodes=(hub,)))
    await stage.screen.go(GraphPlace(GraphKind.NODE, "/hub"))
    await stage.pilot.pause()
    await stage.press("right")
    await held(stage, "down", 60, GraphPlace(GraphKind.TOPIC, "/topic_59"))
    assert "/topic_59" in stage.seen()
    assert "/hub" in stage.seen()

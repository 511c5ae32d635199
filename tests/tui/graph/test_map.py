"""The graph drawn: what the drawing shows, and how one walks on it."""

from __future__ import annotations

from collections.abc import AsyncIterator

import pytest

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


async def test_arrows_walk_and_enter_goes_on_from_there(stage: GraphStage) -> None:
    assert stage.screen.map.here == GraphPlace(GraphKind.NODE, "/safety_stop")
    await stage.press("right", "up", "up", "up", "down")
    assert stage.screen.map.here == GraphPlace(GraphKind.NODE, "/electronic_differential")
    await stage.press("enter")
    assert stage.screen.map.here == GraphPlace(GraphKind.NODE, "/electronic_differential")
    assert "/wheel_commands" in stage.seen()
    await stage.press("escape")
    assert stage.screen.map.here == GraphPlace(GraphKind.NODE, "/safety_stop")

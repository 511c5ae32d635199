"""A name that its list has no room for is told whole beside it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from textual.pilot import Pilot

from graph.data import NodeRow
from launcher.status import NodeState, NodeStatus
from tests.tui.app_runs import opened
from tests.tui.recorded import NODES, RecordedGraph, RecordedOpener, RecordedSession, lesson_update
from tests.tui.snapshots import Look, SnapCompare, one_look, settle
from tui.app import DeckApp
from tui.deck.screen import LessonDeck
from tui.graph.screen import GraphScreen
from tui.widgets.name_head import NameHead

pytestmark = pytest.mark.nightly

NAME = "/z_robot/" + "a_rather_long_name_of_a_node_" * 3 + "END"


@pytest.mark.parametrize("size", [(80, 24), (120, 40)])
async def test_the_detail_of_a_node_has_its_whole_name(size: tuple[int, int]) -> None:
    now = lesson_update()
    graph = RecordedGraph(replace(now, nodes=(NodeRow(NAME), *now.nodes)))
    async with opened(RecordedOpener(graph=graph), "graph", size) as (app, pilot):
        assert isinstance(app.screen, GraphScreen)
        await settle(pilot)
        await pilot.press("end")
        await settle(pilot)
        head = app.screen.query_one(NameHead)
        lines = [head.render_line(y).text.strip() for y in range(head.size.height)]
        assert NAME in "".join(lines)


LONG = "a_rather_long_name_of_a_node_" * 3 + "END"
REASON = "waits for /camera/color/image_raw of sensor_msgs/msg/Image, which nobody publishes; " * 2
STATES = [
    (replace(NODES["camera"], name=LONG), [LONG, "● ready · nodes.mock_camera"]),
    (
        NodeStatus("camera", "nodes.mock_camera", NodeState.WAITING, REASON),
        ["camera", "◌ waiting · " + REASON.strip()],
    ),
]


def opener_with(node: NodeStatus) -> RecordedOpener:
    """Lesson 9 whose last node is this one."""
    nodes = {**NODES, node.name: node}
    return RecordedOpener(RecordedSession(nodes={name: nodes[name] for name in nodes}))


def told_below(app: DeckApp) -> list[str]:
    """The name and the rest, as they stand on the screen between the table and what follows."""
    assert isinstance(app.screen, LessonDeck)
    head = app.screen.query_one(NameHead)
    if not head.display:
        return []
    x, y, width, height = head.region
    screen = app.screen._compositor.render_strips()
    return [screen[row].crop(x, x + width).text.strip() for row in range(y, y + height)]


@pytest.mark.parametrize("size", [(80, 24), (100, 30), (120, 40)])
@pytest.mark.parametrize(("node", "expected"), STATES, ids=["name", "reason"])
async def test_what_the_table_of_nodes_cuts_stands_whole_below_it(
    size: tuple[int, int], node: NodeStatus, expected: list[str]
) -> None:
    async with opened(opener_with(node), size=size) as (app, pilot):
        assert isinstance(app.screen, LessonDeck)
        assert told_below(app) == []
        app.screen.table.choose(node.name)
        await settle(pilot)
        told = " ".join(told_below(app))
        for words in expected:
            assert words.replace(" ", "") in told.replace(" ", "")
        assert app.screen.table.size.height >= 2
        app.screen.table.choose("audio")
        await settle(pilot)
        assert told_below(app) == []


async def test_it_is_told_as_soon_as_the_window_is_too_narrow_for_it() -> None:
    node = replace(NODES["camera"], name=LONG[:60])
    async with opened(opener_with(node), size=(200, 60)) as (app, pilot):
        assert isinstance(app.screen, LessonDeck)
        app.screen.table.choose(node.name)
        await settle(pilot)
        for size, cut in (((200, 60), False), ((80, 24), True), ((200, 60), False)):
            await pilot.resize_terminal(*size)
            await settle(pilot)
            assert bool(told_below(app)) == cut, size


@one_look
def test_a_name_and_a_reason_that_are_cut(look: Look, dump_compare: SnapCompare) -> None:
    """The table, below it the chosen node's whole name and state, and the log as ever."""

    async def choose(pilot: Pilot[Any]) -> None:
        await look.settle(pilot)
        assert isinstance(app.screen, LessonDeck)
        app.screen.table.choose(LONG)
        await look.settle(pilot)

    node = replace(NODES["camera"], name=LONG, state=NodeState.FAILED, detail=REASON, pid=None)
    app = look.app("deck", opener_with(node))
    assert dump_compare(app, terminal_size=look.size, run_before=choose)

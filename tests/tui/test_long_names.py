"""A name that its list has no room for is told whole beside it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from graph.data import NodeRow
from tests.tui.app_runs import opened
from tests.tui.recorded import RecordedGraph, RecordedPad, lesson_update
from tests.tui.snapshots import settle
from tui.screens.graph import GraphScreen
from tui.widgets.graph_pane import GraphHead

NAME = "/z_robot/" + "a_rather_long_name_of_a_node_" * 3 + "END"


@pytest.mark.parametrize("size", [(80, 24), (120, 40)])
async def test_the_detail_of_a_node_has_its_whole_name(size: tuple[int, int]) -> None:
    now = lesson_update()
    graph = RecordedGraph(replace(now, nodes=(NodeRow(NAME), *now.nodes)))
    async with opened(RecordedPad(graph=graph), "graph", size) as (app, pilot):
        assert isinstance(app.screen, GraphScreen)
        await settle(pilot)
        await pilot.press("end")
        await settle(pilot)
        head = app.screen.query_one(GraphHead)
        lines = [head.render_line(y).text.strip() for y in range(head.size.height)]
        assert NAME in "".join(lines)

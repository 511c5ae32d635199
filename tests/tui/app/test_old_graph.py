"""While nothing is heard of the graph, the title says since when; keys go on working."""

from __future__ import annotations

from dataclasses import replace

from tests.tui.app_runs import opened
from tests.tui.recorded import RecordedOpener, lesson_update
from tests.tui.snapshots import settle
from tui.clock import time_of_day
from tui.frame.title_bar import TitleBar

SINCE_S = 1_700_000_000.0


async def test_the_title_says_since_when_what_is_shown_is_old() -> None:
    opener, update = RecordedOpener(), lesson_update()
    async with opened(opener, size=(200, 40)) as (app, pilot):
        bar = app.screen.query_one(TitleBar)

        async def shown(since_s: float | None) -> str:
            opener.graph.show(replace(update, old_since_s=since_s))
            await settle(pilot)
            return bar.text

        assert "No word" not in await shown(None)
        assert f"No word of the ROS graph since {time_of_day(SINCE_S)}" in await shown(SINCE_S)
        await pilot.resize_terminal(120, 24)
        await settle(pilot)
        assert f"graph of {time_of_day(SINCE_S)}" in bar.text
        await pilot.press("space")
        await settle(pilot)
        assert opener.graph.published[-1][2] == {"data": True}

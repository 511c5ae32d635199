"""Panels with a history go on with it while another tab is in front, and draw nothing meanwhile."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from tests.tui.app_runs import opened
from tests.tui.panel_stage import rows
from tests.tui.recorded import RecordedGraph, RecordedOpener, RecordedSession
from tests.tui.recorded_lesson import NOW_S
from tests.tui.recorded_map import MAP_SESSION, map_update, reading
from tests.tui.snapshots import settle
from tui.panels.sonar.widget import Sonar

if TYPE_CHECKING:
    from graph.data import GraphUpdate, Sample

KEPT = {"/sensor/sonar_front", "/sensor/sonar_rear", "/odom"}


def with_map() -> RecordedOpener:
    return RecordedOpener(RecordedSession(MAP_SESSION), RecordedGraph(map_update()))


def said(one: Sample) -> GraphUpdate:
    """Nothing but this has come."""
    return replace(map_update(), samples={one.topic: (one,)})


async def test_the_trend_of_a_sonar_has_no_gap_where_the_tab_was_another() -> None:
    opener = with_map()
    async with opened(opener) as (app, pilot):
        gauge = app.screen.query_one("#front", Sonar)
        await pilot.press("2")
        await settle(pilot)
        for second in range(1, 41):
            one = replace(reading("front", 0.2), received_s=NOW_S + second)
            opener.graph.show(said(one))
            await pilot.pause()
        await pilot.press("1")
        await settle(pilot)
        assert "STOP" in rows(gauge)[0]
        assert list(gauge._values)[-40:] == [0.2] * 40


async def test_only_what_has_a_history_is_asked_for_while_unseen() -> None:
    opener = with_map()
    async with opened(opener) as (_app, pilot):
        assert opener.graph.watched > KEPT
        await pilot.press("2")
        await settle(pilot)
        assert opener.graph.watched >= KEPT
        assert "/map" not in opener.graph.watched
        assert "/odom" not in opener.graph.followed

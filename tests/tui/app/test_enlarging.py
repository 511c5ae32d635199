"""One part of a screen in the place of all others, by key and by mouse, on every screen."""

from __future__ import annotations

import pytest
from textual.widget import Widget

from course.lessons.catalog import SHIPPED
from course.lessons.lesson import LessonFolder
from tests.tui import recorded_flow
from tests.tui.recorded import NOW_S
from tests.tui.recorded_devices import with_drivers
from tests.tui.snapshots import opened
from tests.waiting import until
from tui.app import DeckApp
from tui.deck.nodes_table import NodesTable
from tui.panels.panel import Panel
from tui.panels.panel_grid import PanelGrid

pytestmark = pytest.mark.nightly


def large(app: DeckApp) -> Widget | None:
    return app.screen.maximized


def fills_the_screen(app: DeckApp) -> bool:
    """Whether the enlarged part has all lines between the title and the keys."""
    part, (width, height) = large(app), app.size
    return part is not None and part.outer_size == (width, height - 2) and part.region.y == 1


async def test_every_panel_is_enlarged_in_turn_and_everything_comes_back() -> None:
    async with opened(size=(80, 24)) as (app, pilot):
        await pilot.press("tab", "z")
        await pilot.pause()
        seen: list[object] = []
        while large(app) not in seen:
            assert isinstance(large(app), Panel)
            assert fills_the_screen(app)
            seen.append(large(app))
            await pilot.press("v")
            await pilot.pause()
        assert seen == list(app.screen.query(Panel))
        await pilot.press("я")
        await pilot.pause()
        assert large(app) is None
        assert isinstance(app.focused, PanelGrid)
        assert app.focused.chosen is seen[0]
        assert app.screen.query_one(NodesTable).region.height > 2


PARTS = {
    "topics": ("z", "TopicDetail"),
    "graph": ("z", "GraphDetail"),
    "logs": ("я", "LogPane"),
    "flow": ("z", "FlowView"),
    "devices": ("z", "LogPane"),
    "composer": ("alt+z", "#composer-right"),
    "lesson": ("z", "#lesson-reading"),
    "deck": ("z", "#nodes"),
}


@pytest.mark.parametrize("screen", PARTS)
async def test_a_part_of_every_screen_is_enlarged_and_comes_back(screen: str) -> None:
    key, part = PARTS[screen]
    opener = with_drivers()
    opener.task = LessonFolder(SHIPPED / "02-sonar-safety")
    async with opened(opener, screen=screen, size=(80, 24)) as (app, pilot):
        opener.graph.show(recorded_flow.update(*recorded_flow.voice(NOW_S)))
        shows = app.screen.query
        await until(lambda: any(one.region.height for one in shows(part)), "the part")
        had = app.focused
        await pilot.press(key)
        await pilot.pause()
        assert large(app) is app.screen.query_one(part)
        assert fills_the_screen(app)
        await pilot.press("escape")
        await pilot.pause()
        assert large(app) is None
        assert app.focused is had

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

pytestmark = pytest.mark.nightly


def large(app: DeckApp) -> Widget | None:
    return app.screen.maximized


def fills_the_screen(app: DeckApp) -> bool:
    """Whether the enlarged part has all lines between the title and the keys."""
    part, (width, height) = large(app), app.size
    return part is not None and part.outer_size == (width, height - 2) and part.region.y == 1


PARTS = {
    "topics": ("z", "TopicDetail"),
    "graph": ("z", "#graph-detail"),
    "logs": ("я", "LogPane"),
    "flow": ("z", "#flow-view"),
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

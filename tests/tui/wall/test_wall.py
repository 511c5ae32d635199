"""The wall: the panels that can be read across a room; the stop in large letters."""

from __future__ import annotations

from dataclasses import replace

import pytest
from textual.widgets import Static

from tests.tui.recorded import SESSION, RecordedGraph, RecordedOpener, RecordedSession, lesson_update
from tests.tui.snapshots import opened
from tests.waiting import until
from tui.app import DeckApp
from tui.deck.screen import LessonDeck
from tui.frame.title_bar import TitleBar
from tui.panels.camera import CameraPanel
from tui.panels.sonar import Sonar, SonarPanel
from tui.panels.voice import VoicePanel
from tui.panels.wheels import WheelsPanel
from tui.wall.screen import WallScreen, big_word
from tui.widgets.image_view import ImageView

pytestmark = pytest.mark.nightly


def wall(app: DeckApp) -> WallScreen:
    assert isinstance(app.screen, WallScreen)
    return app.screen


def state(app: DeckApp) -> str:
    return str(app.screen.query_one("#wall-state", Static).content)


async def test_a_key_shows_it_and_escape_goes_back() -> None:
    async with opened() as (app, pilot):
        await pilot.press("0")
        await until(lambda: isinstance(app.screen, WallScreen), "the wall")
        await until(lambda: wall(app).grid.panels, "the panels")
        assert [type(panel) for panel in wall(app).grid.panels] == [
            SonarPanel, CameraPanel, WheelsPanel, VoicePanel,
        ]  # fmt: skip
        await until(lambda: app.screen.query_one(ImageView).has_picture, "the picture")
        assert all(sonar.has_value for sonar in app.screen.query(Sonar) if sonar.display)
        assert state(app) == "● The gate lets the wheels turn"
        await pilot.press("escape")
        await until(lambda: isinstance(app.screen, LessonDeck), "the Deck")


async def test_the_stop_is_in_large_letters_and_the_title_stays() -> None:
    async with opened(screen="wall", size=(80, 24)) as (app, pilot):
        await pilot.press("space")
        await pilot.pause()
        letters = app.screen.query_one("#wall-state", Static)
        assert state(app).startswith(big_word("STOP"))
        assert letters.region.height >= 7
        assert letters.has_class("-stop")
        assert "STOP" in app.screen.query_one(TitleBar).text
        assert app.screen.query_one(SonarPanel).region.height > 2
        assert wall(app).grid.pages == 2
        await pilot.press("v")
        assert app.screen.query_one(VoicePanel).display
        await pilot.press("ctrl+r")
        await until(lambda: not state(app).startswith(big_word("STOP")), "the release")


async def test_without_anything_to_show_it_says_so() -> None:
    bare = RecordedSession(replace(SESSION, panels=()), lines=())
    opener = RecordedOpener(bare, RecordedGraph(lesson_update(topics=(), samples={})))
    async with opened(opener, screen="wall") as (app, _pilot):
        assert "Nothing that the wall could show" in state(app)

"""The tour of the first start: pages above the list of lessons, left at once by Escape."""

from __future__ import annotations

import pytest

from tests.tui.recorded import RecordedOpener
from tests.tui.snapshots import opened, seen, settle
from text.i18n import LANGUAGES, set_language
from tui.app import DeckApp
from tui.picker.screen import PickerScreen
from tui.session.requests import OpenRequest
from tui.tour.pages import PAGES
from tui.tour.screen import TourScreen


class Environment:
    """What the app finds on a terminal, and what it was told to remember."""

    terminal_fd = 1

    def __init__(self, *, due: bool) -> None:
        self.due = due
        self.kept: dict[str, str] = {}

    def arrive(self, app: DeckApp) -> None:
        app.tour_is_due = self.due

    def desert(self) -> None:
        """Its terminal stays."""

    def remember(self, **values: str) -> None:
        self.kept.update(values)


def started(environment: Environment, order: OpenRequest) -> DeckApp:
    return DeckApp(RecordedOpener(), order, environment=environment)


async def test_the_first_start_shows_it_and_escape_leaves_it_for_good() -> None:
    environment = Environment(due=True)
    app = started(environment, OpenRequest())
    async with app.run_test(size=(80, 24)) as pilot:
        await settle(pilot)
        assert isinstance(app.screen, TourScreen)
        assert environment.kept["tour"] == "seen"
        await pilot.press("enter", "escape")
        await settle(pilot)
        assert isinstance(app.screen, PickerScreen)


@pytest.mark.parametrize("language", LANGUAGES)
async def test_every_page_fits_80x24(language: str) -> None:
    async with opened(order=OpenRequest(), size=(80, 24)) as (app, pilot):
        set_language(language)
        app.show_tour()
        await pilot.pause()
        for _page in PAGES:
            scroll = app.screen.query_one("#dialog-scroll")
            assert scroll.max_scroll_y == 0, seen(app)
            await pilot.press("n")
            await pilot.pause()

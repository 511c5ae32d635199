"""What every test of the screen gets: colours, no motion, a clock that stands, English."""

from __future__ import annotations

import os

os.environ.update(TEXTUAL_ANIMATIONS="none", COLORTERM="truecolor", TEXTUAL_COLOR_SYSTEM="truecolor")
os.environ.pop("NO_COLOR", None)

import time
from collections.abc import Iterator

import pytest
from textual.app import App
from textual.css.model import RuleSet
from textual.css.stylesheet import Stylesheet
from textual.css.types import CSSLocation
from textual.screen import Screen

from tests.tui.recorded import NOW_S
from text.i18n import set_language
from tui import clock


@pytest.fixture(autouse=True, scope="session")
def _css_is_parsed_once() -> Iterator[None]:
    """Keep the rules of a widget's CSS from app to app, as an app itself does between screens."""
    parse, parsed = Stylesheet._parse_rules, {}

    def remembered(
        sheet: Stylesheet,
        css: str,
        read_from: CSSLocation,
        is_default_rules: bool = False,
        tie_breaker: int = 0,
        scope: str = "",
    ) -> list[RuleSet]:
        source = (css, read_from, is_default_rules, tie_breaker, scope)
        key = (source, frozenset(sheet._variables.items()))
        if key not in parsed:
            parsed[key] = parse(sheet, *source)
        return parsed[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Stylesheet, "_parse_rules", remembered)
        yield


@pytest.fixture(autouse=True)
def _only_what_is_looked_at_is_drawn(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw no frame that no terminal gets: it was two fifths of the time of these tests.

    Of a picture the whole screen is drawn once. Tests marked `every_frame` are about what is drawn
    on the way to it, or about a widget that takes its size from it.
    """
    if request.node.get_closest_marker("every_frame"):
        return
    refresh = Screen._compositor_refresh

    def seen(screen: Screen[object]) -> None:
        app = screen.app
        if screen is not app.screen or not app.is_headless:
            refresh(screen)
            return
        screen._compositor._dirty_regions.clear()
        screen._dirty_widgets.clear()
        app._update_mouse_over(screen)

    monkeypatch.setattr(Screen, "_compositor_refresh", seen)


@pytest.fixture(autouse=True, scope="session")
def _no_timer_runs_at_the_end() -> Iterator[None]:
    """Take an app down as `App.exit` does, after which no timer calls anything.

    `run_test` leaves that out, and closes the screens that are not in front widget by widget: a
    timer of a screen would look for what has just been closed.
    """
    close_all = App._close_all

    async def close(app: App[object]) -> None:
        app._exit = True
        await close_all(app)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(App, "_close_all", close)
        yield


@pytest.fixture(autouse=True)
def _still(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Stop cursors and clocks, speak English, and set the language back afterwards."""
    monkeypatch.setattr(clock, "now", lambda: NOW_S + 17.0)
    monkeypatch.setenv("TZ", "UTC")
    time.tzset()
    # Textual may have been imported before the lines above were read.
    monkeypatch.setenv("COLORTERM", "truecolor")
    set_language("en")
    yield
    set_language("en")
    monkeypatch.undo()
    time.tzset()

"""What is typed without a pause after a key that moves the cursor is not lost."""

from __future__ import annotations

from collections.abc import AsyncIterator

import pytest
from textual.events import Event, Key, Paste
from textual.widgets import Input

from tests.tui.recorded import RecordedGraph, RecordedOpener
from tests.tui.snapshots import Look, settle
from tests.waiting import DEADLINE_S, until
from tui.app import DeckApp
from tui.terminal import key_queue

HOME = Look((120, 40), "en")
NAMES = "#topics-filter, #graph-filter"
SIGNS = {"slash": "/", "space": " "}


@pytest.fixture
async def app(monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[DeckApp]:
    # On a busy machine a screen may take longer to open than a person is left waiting.
    monkeypatch.setattr(key_queue, "PATIENCE_S", DEADLINE_S)
    app = HOME.app("deck", RecordedOpener(graph=RecordedGraph()))
    async with app.run_test(size=HOME.size) as pilot:
        await settle(pilot)
        yield app


def type_at_once(app: DeckApp, *keys: str, then: Event | None = None) -> None:
    """Post keys as a terminal does whose program was busy: none has been dealt with yet."""
    for key in keys:
        app.post_message(Key(key, SIGNS.get(key, key if len(key) == 1 else None)))
    if then is not None:
        app.post_message(then)


async def until_filter_is(app: DeckApp, words: str) -> None:
    def found() -> list[str]:
        return [filter_.value for filter_ in app.screen.query(Input).filter(NAMES)]

    await until(lambda: found() == [words], lambda: f"{words!r} in the filter, but {found()}")


async def test_what_is_typed_after_a_key_that_moves_the_cursor_is_not_lost(app: DeckApp) -> None:
    type_at_once(app, "f3", "slash", *"drive")
    await until_filter_is(app, "drive")
    type_at_once(app, "enter", "slash", *"_s")
    await until_filter_is(app, "drive_s")
    type_at_once(app, "escape", "slash", then=Paste("sonar"))
    await until_filter_is(app, "sonar")
    type_at_once(app, "escape", "5", "slash", *"brain")
    await until_filter_is(app, "brain")


async def test_the_stop_waits_for_no_key(app: DeckApp) -> None:
    type_at_once(app, "f3", "slash", "a", "space", "b")
    await until(lambda: app.emergency.state.engaged, "the stop")
    await until_filter_is(app, "ab")

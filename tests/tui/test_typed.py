"""Typing faster than the screen draws: nothing is lost, and the stop does not wait."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import pytest
from textual.events import Key, Paste
from textual.widgets import Input, Static

from tests.tui.recorded import RecordedGraph, RecordedPad
from tests.tui.snapshots import Look, settle
from tui import typed

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable

    from textual.events import Event

    from tui.app import DeckApp

HOME = Look((120, 40), "en")
SIGNS = {"slash": "/", "space": " "}


@pytest.fixture
async def app() -> AsyncIterator[DeckApp]:
    app = HOME.app("deck", RecordedPad(graph=RecordedGraph()))
    async with app.run_test(size=HOME.size) as pilot:
        await settle(pilot)
        yield app


def type_at_once(app: DeckApp, *keys: str, then: Event | None = None) -> None:
    """Post keys as a terminal does whose program was busy: none has been dealt with yet."""
    for key in keys:
        app.post_message(Key(key, SIGNS.get(key, key if len(key) == 1 else None)))
    if then is not None:
        app.post_message(then)


async def until(condition: Callable[[], bool]) -> None:
    for _round in range(2000):
        if condition():
            return
        await asyncio.sleep(0.01)
    pytest.fail("not within 20 s")


def filter_is(app: DeckApp, words: str) -> Callable[[], bool]:
    return lambda: [found.value for found in app.screen.query(Input)] == [words]


async def test_what_is_typed_after_a_key_that_moves_the_cursor_is_not_lost(app: DeckApp) -> None:
    type_at_once(app, "f3", "slash", *"drive")
    await until(filter_is(app, "drive"))
    type_at_once(app, "enter", "slash", *"_s")
    await until(filter_is(app, "drive_s"))
    type_at_once(app, "escape", "slash", then=Paste("sonar"))
    await until(filter_is(app, "sonar"))
    type_at_once(app, "escape", "5", "slash", *"brain")
    await until(filter_is(app, "brain"))


async def test_the_stop_waits_for_no_key(app: DeckApp) -> None:
    type_at_once(app, "f3", "slash", "a", "space", "b")
    await until(lambda: app.brake.state.engaged)
    await until(filter_is(app, "ab"))


async def test_a_key_that_never_arrives_holds_up_the_others_for_a_moment_only(
    app: DeckApp, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patched:
        patched.setattr(typed, "PATIENCE_S", 0.05)
        app._typed.follow(Static())
    type_at_once(app, "f3", "slash", *"drive")
    await until(filter_is(app, "drive"))

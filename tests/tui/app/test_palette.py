"""The palette: what can be done on any screen is found by its name, in either language."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import pytest
from textual.command import CommandPalette
from textual.pilot import Pilot
from textual.widgets import OptionList

from tests.tui.app_runs import opened
from tests.tui.recorded import RecordedOpener
from tests.waiting import until
from tui.actions import REGISTRY
from tui.app import DeckApp
from tui.palette import PLACES, entries
from tui.screens import SCREENS
from tui.session.requests import OpenRequest


def found(app: DeckApp) -> list[str]:
    """Return what the palette lists now: name and sentence of each, the likeliest first."""
    if not isinstance(app.screen, CommandPalette):
        return []
    return [str(option.prompt) for option in app.screen.query_one(OptionList).options]


def is_searched(app: DeckApp) -> bool:
    """Whether the palette has found all that it will find for what is typed."""
    return all(worker.is_finished for worker in app.workers if worker.node is app.screen)


async def look_for(app: DeckApp, pilot: Pilot[Any], words: str, expected: str) -> list[str]:
    """Type words into the palette, wait until something expected is listed; return the list."""

    def listed() -> bool:
        return is_searched(app) and any(expected in line for line in found(app))

    await pilot.press("ctrl+p")
    await until(lambda: is_searched(app) and found(app), "what is offered at first")
    await pilot.press(*words)
    await until(listed, lambda: f"{expected!r} in the palette, but {found(app)}")
    return found(app)


async def take(app: DeckApp, pilot: Pilot[Any], name: str) -> None:
    """Choose what is listed under this name."""
    place = next(i for i, line in enumerate(found(app)) if line.splitlines()[0] == name)
    await pilot.press(*["down"] * place, "enter")
    await until(lambda: not isinstance(app.screen, CommandPalette), "the palette gone")


async def told(app: DeckApp, words: str) -> None:
    """Wait until this is told in the corner."""

    def notes() -> str:
        return "\n".join(note.message for note in app._notifications)

    await until(lambda: words in notes(), lambda: f"{words!r} in the corner, but {notes()!r}")


async def test_it_finds_an_action_by_name_and_does_it() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await pilot.press("down")
        await look_for(app, pilot, "restart", "Restart all")
        await take(app, pilot, "Restart")
        await until(lambda: opener.link.asked, "what is asked of the nodes")
        assert opener.link.asked == [("restart", "camera")]


async def test_before_anything_is_typed_it_offers_only_what_is_possible_here() -> None:
    async with opened() as (app, _pilot):
        offered = {entry.title for entry in entries(app, app.screen) if entry.offered}
        assert {"Restart", "STOP", "Русский"} <= offered
        assert "Release" not in offered
        assert not any("›" in title for title in offered)


@pytest.mark.parametrize(
    ("language", "typed", "title"),
    [
        ("ru", "график", "Топики › График"),
        ("ru", "plot", "Топики › График (Plot)"),
        ("en", "plot", "Topics › Plot"),
        ("en", "график", "Topics › Plot (График)"),
    ],
)
async def test_an_action_of_another_screen_is_found_in_either_language_with_its_place(
    language: str, typed: str, title: str
) -> None:
    async with opened() as (app, pilot):
        app.speak(language)
        lines = await look_for(app, pilot, typed, title)
        assert title in [line.splitlines()[0] for line in lines]


async def test_what_acts_is_only_gone_to_and_its_key_is_told() -> None:
    opener = RecordedOpener()
    async with opened(opener, "topics") as (app, pilot):
        await look_for(app, pilot, "restart", "Deck › Restart all")
        await take(app, pilot, "Deck › Restart all")
        await told(app, "Restart all is here: R.")
        assert app.screen is app.get_screen("deck")
        assert opener.link.asked == []


async def test_what_is_impossible_here_is_found_too() -> None:
    async with opened() as (app, pilot):
        await look_for(app, pilot, "release", "Release (not possible now)")
        await take(app, pilot, "Release (not possible now)")
        await told(app, "Release the emergency stop: nodes may")


async def test_beside_the_list_of_lessons_it_says_that_a_lesson_comes_first() -> None:
    async with opened(order=OpenRequest()) as (app, pilot):
        await look_for(app, pilot, "plot", "Topics › Plot")
        await take(app, pilot, "Topics › Plot")
        await told(app, "Plot is on the screen Topics: open a lesson first.")


def test_every_action_of_every_screen_has_its_place() -> None:
    for name, (module, made) in SCREENS.items():
        screen = getattr(import_module(module), made)
        # What every screen inherits is offered on each of them.
        own = vars(screen).get("BINDINGS", ())
        bound = {each.id for each in own if each.id in REGISTRY}
        placed = {
            action.id for place in PLACES if place.show.screen == name for action in place.actions
        }
        assert name == "picker" or bound <= placed, name

"""One class per action: keys, footer, palette, help and keymap come from it."""

from __future__ import annotations

from functools import partial
from typing import Any

import pytest
from textual._ansi_sequences import ANSI_SEQUENCES_KEYS
from textual.command import CommandPalette
from textual.pilot import Pilot
from textual.screen import Screen
from textual.widgets import Input, OptionList, TextArea

from launcher.status import NodeState
from tests.tui import topics_stage
from tests.tui.recorded import RecordedOpener
from tests.tui.snapshots import opened, seen, settle
from tests.waiting import until
from tui.actions import REGISTRY
from tui.app import DeckApp
from tui.frame.actions.app import SHOW, TABS
from tui.frame.key_bar import KeyBar
from tui.help.page import Page
from tui.help.screen import HelpScreen
from tui.palette import PLACES
from tui.screens import SCREENS, every_action
from tui.teleop.actions import MOVES
from tui.terminal.pixels import GraphicsChanged
from tui.widgets.drawing import Drawing


def footer(app: DeckApp) -> str:
    return str(app.screen.query_one(KeyBar).render())


def help_text(app: DeckApp) -> str:
    assert isinstance(app.screen, HelpScreen)
    return " ".join(app.screen.query_one(Page).text.split())


def test_terminals_can_send_every_key() -> None:
    """Alt+F, for one, is sent as what Ctrl+Right is in Emacs, and read as that."""
    for name in every_action():
        for key in REGISTRY[name].key.split(","):
            assert key.replace("alt+", "\x1b") not in ANSI_SEQUENCES_KEYS, name
            # The answer to a question about the cursor, ESC [ 1 ; 2 R, looks like it.
            assert key != "shift+f3", name


DIALOGS = frozenset({"enter", "escape"})
"""Enter takes what a dialog offers, Escape leaves it: what that is, stands beside the key."""


def keys_of_every_screen() -> dict[str, dict[str, list[str]]]:
    """Return key -> what it is for -> the actions that have it.

    The keys held to drive are those of a game, and named in their panel while they are taken.
    """
    table: dict[str, dict[str, list[str]]] = {}
    for name in every_action():
        action = REGISTRY[name]
        for key in () if action in MOVES else action.key.split(","):
            table.setdefault(key, {}).setdefault(action.means or action.title, []).append(name)
    return table


def test_a_key_means_one_thing_on_every_screen() -> None:
    table = keys_of_every_screen()
    doubled = {key: meanings for key, meanings in table.items() if len(meanings) > 1}
    assert doubled.keys() <= DIALOGS, doubled


def test_a_russian_letter_means_what_the_key_that_it_stands_on_does() -> None:
    table = keys_of_every_screen()
    on_a_key = str.maketrans("фисвуапршолдьтщзйкыегмцчня", "abcdefghijklmnopqrstuvwxyz")
    for key, meanings in table.items():
        latin = key.lower().translate(on_a_key)
        if len(key) == 1 and latin != key.lower():
            latin = latin.upper() if key.isupper() else latin
            assert meanings == table[latin], (key, latin)


async def test_the_footer_shows_what_can_be_done_now() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        assert "space STOP" in footer(app)
        assert "Release" not in footer(app)
        await pilot.press("space")
        await pilot.pause()
        assert "^r Release" in footer(app)
        await pilot.press("c")
        await pilot.pause()
        assert "^x STOP" in footer(app)
        assert "Restart" not in footer(app)


async def test_help_lists_every_key_of_the_screen_and_closes_again() -> None:
    async with opened() as (app, pilot):
        deck = app.screen
        await pilot.press("f1")
        await pilot.pause()
        page = help_text(app)
        for name in ("node.restart", "log.only", "emergency.release"):
            assert REGISTRY[name].title in page
            assert REGISTRY[name].tooltip in page
        await pilot.press("escape")
        await pilot.pause()
        assert app.screen is deck


async def test_a_keymap_changes_key_footer_and_help() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        app.set_keymap({"node.restart": "f7"})
        await pilot.press("f7", "r")
        await pilot.pause()
        assert opener.link.asked == [("restart", "sonar_front")]
        assert "f7 Restart" in footer(app)
        await pilot.press("f1")
        await pilot.pause()
        assert "f7" in help_text(app)


async def test_language_is_switched_by_a_key_and_everything_visible_changes() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        opener.link.set_state("camera", NodeState.FAILED)
        await pilot.press("f9")
        await settle(pilot)
        screen = seen(app)
        for words in ("Пульт", "Узел", "✗ сбой", "Сонар", "Колёса", "5 Граф", "пробел СТОП"):
            assert words in screen
        for words in ("failed", "Sonar", "domain", "STOP"):
            assert words not in screen


async def test_a_topic_is_echoed() -> None:
    async with topics_stage.opened() as stage:
        await stage.choose(topics_stage.SONAR)
        await stage.pilot.press("Y")
        await stage.pilot.pause()
        assert stage.app.clipboard == f"ros2 topic echo {topics_stage.SONAR}"


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
    place = next(i for i, line in enumerate(found(app)) if line.splitlines()[0] == name)
    await pilot.press(*["down"] * place, "enter")
    await until(lambda: not isinstance(app.screen, CommandPalette), "the palette gone")


async def test_it_finds_an_action_by_name_and_does_it() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await pilot.press("down")
        await look_for(app, pilot, "restart", "Restart all")
        await take(app, pilot, "Restart")
        await until(lambda: opener.link.asked, "what is asked of the nodes")
        assert opener.link.asked == [("restart", "camera")]


@pytest.mark.parametrize(
    ("language", "typed", "title"), [("ru", "plot", "Топики › График (Plot)"), ("en", "plot", "Topics › Plot")]
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
        told = "Restart all is here: R."
        notes = app._notifications
        await until(lambda: any(told in note.message for note in notes), "where it is")
        assert app.screen is app.get_screen("deck")
        assert opener.link.asked == []


def test_every_action_of_every_screen_has_its_place() -> None:
    for name, entry in SCREENS.items():
        screen = entry.load()
        # What every screen inherits is offered on each of them.
        own = vars(screen).get("BINDINGS", ())
        bound = {each.id for each in own if each.id in REGISTRY}
        placed = {action.id for place in PLACES if place.screen == name for action in place.actions}
        assert name == "picker" or bound <= placed, name


def in_front(app: DeckApp, name: str) -> bool:
    return getattr(app.screen, "tab", "") == name


async def test_no_key_of_the_tabs_is_typed_into_a_field_that_nobody_has_entered(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Not even in the moment in which a screen opens."""
    focused: list[object] = []
    focus = Screen.set_focus

    def noted(self: Screen[Any], widget: Any, *more: Any, **others: Any) -> None:
        focused.append(widget)
        focus(self, widget, *more, **others)

    monkeypatch.setattr(Screen, "set_focus", noted)
    async with opened() as (app, pilot):
        for tab in [*TABS, *reversed(TABS), SHOW["wall"], SHOW["composer"], SHOW["wall"]]:
            await pilot.press(tab.key.split(",")[0])
            await until(partial(in_front, app, tab.id.removeprefix("screen.")), tab.id)
        assert [one for one in focused if isinstance(one, (Input, TextArea))] == []


async def test_when_the_terminals_pixels_change_every_widget_hears_of_it(monkeypatch: pytest.MonkeyPatch) -> None:
    heard: list[Drawing] = []
    monkeypatch.setattr(Drawing, "on_graphics_changed", lambda panel: heard.append(panel))  # noqa: PLW0108
    async with opened() as (app, _pilot):
        app.post_message(GraphicsChanged())
        await until(lambda: heard, "a panel that has heard", 10)
        assert not app.crashed

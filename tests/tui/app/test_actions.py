"""One class per action: keys, footer, palette, help and keymap all come from it."""

from __future__ import annotations

import string

from textual._ansi_sequences import ANSI_SEQUENCES_KEYS

from launcher.status import NodeState
from tests.tui.app_runs import opened
from tests.tui.recorded import RecordedOpener
from tui.actions import REGISTRY
from tui.app import DeckApp
from tui.frame.key_bar import KeyBar
from tui.help.page import Page
from tui.help.screen import HelpScreen
from tui.screens import every_action
from tui.teleop.actions import MoveAction


def footer(app: DeckApp) -> str:
    """Return the keys that are shown."""
    return str(app.screen.query_one(KeyBar).render())


def help_text(app: DeckApp) -> str:
    """Return the whole help page."""
    assert isinstance(app.screen, HelpScreen)
    return " ".join(app.screen.query_one(Page).text.split())


def test_every_action_has_its_own_id_a_title_and_a_sentence() -> None:
    for name in every_action():
        action = REGISTRY[name]
        assert action.id == name
        assert action.title
        assert action.tooltip.endswith("."), name


def test_terminals_can_send_every_key() -> None:
    """Alt+F, for one, is sent as what Ctrl+Right is in Emacs, and read as that."""
    for name in every_action():
        for key in REGISTRY[name].key.split(","):
            assert key.replace("alt+", "\x1b") not in ANSI_SEQUENCES_KEYS, name
            # The answer to a question about the cursor, ESC [ 1 ; 2 R, looks like it.
            assert key != "shift+f3", name


CURSOR = frozenset("hjklgG")
"""Letters that move the cursor in lists and trees, beside the arrow keys."""
DIALOGS = frozenset({"enter", "escape"})
"""Enter takes what a dialog offers, Escape leaves it: what that is, stands beside the key."""


def keys_of_every_screen() -> dict[str, dict[str, list[str]]]:
    """Return key -> what it is for -> the actions that have it.

    The keys held to drive are those of a game, and named in their panel while they are taken.
    """
    table: dict[str, dict[str, list[str]]] = {}
    for name in every_action():
        action = REGISTRY[name]
        for key in () if issubclass(action, MoveAction) else action.key.split(","):
            table.setdefault(key, {}).setdefault(action.means or action.title, []).append(name)
    return table


def test_a_key_means_one_thing_on_every_screen() -> None:
    table = keys_of_every_screen()
    doubled = {key: meanings for key, meanings in table.items() if len(meanings) > 1}
    assert doubled.keys() <= DIALOGS, doubled


def test_no_action_takes_a_letter_that_moves_the_cursor() -> None:
    assert CURSOR.isdisjoint(keys_of_every_screen())


def test_a_russian_letter_means_what_the_key_that_it_stands_on_does() -> None:
    table = keys_of_every_screen()
    on_a_key = str.maketrans("фисвуапршолдьтщзйкыегмцчня", "abcdefghijklmnopqrstuvwxyz")
    for key, meanings in table.items():
        latin = key.lower().translate(on_a_key)
        if len(key) == 1 and latin != key.lower():
            latin = latin.upper() if key.isupper() else latin
            assert meanings == table[latin], (key, latin)


def test_letters_work_on_a_russian_keyboard_too() -> None:
    for name in every_action():
        keys = REGISTRY[name].key.split(",")
        letters = [key for key in keys if key in string.ascii_letters]
        if letters:
            assert any("Ѐ" <= key <= "ӿ" for key in keys), name


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


async def test_the_footer_keeps_the_stop_on_the_narrowest_terminal() -> None:
    async with opened(size=(40, 12)) as (app, _pilot):
        assert "space STOP" in footer(app)
        assert "q Quit" in footer(app)


async def test_help_lists_every_key_of_the_screen_and_closes_again() -> None:
    async with opened() as (app, pilot):
        deck = app.screen
        await pilot.press("f1")
        await pilot.pause()
        page = help_text(app)
        for action in (*map(REGISTRY.get, ("node.restart", "log.only", "emergency.release")),):
            assert action is not None
            assert action.title in page
            assert action.tooltip in page
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


async def test_themes_are_gone_through_by_a_key() -> None:
    async with opened() as (app, pilot):
        seen = [app.theme]
        for _press in range(3):
            await pilot.press("f10")
            await pilot.pause()
            seen.append(app.theme)
        assert seen == ["textual-dark", "textual-light", "high-contrast", "textual-dark"]


async def test_language_is_switched_by_a_key_and_everything_visible_changes() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        opener.link.set_state("camera", NodeState.FAILED)
        await pilot.press("f9")
        await pilot.pause()
        await pilot.pause()
        screen = "\n".join(strip.text for strip in app.screen._compositor.render_strips())
        for words in ("Пульт", "Узел", "✗ сбой", "Сонар", "Колёса", "5 Граф", "пробел СТОП"):
            assert words in screen
        for words in ("failed", "Sonar", "domain", "STOP"):
            assert words not in screen

"""Theme, language and keys outlast the program; a broken file is refused with its place."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.e2e.conftest import Deck
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly


def settings_of(deck: Deck) -> Path:
    return Path(deck.env["XDG_CONFIG_HOME"]) / "deck" / "settings.json"


def test_theme_and_language_are_there_the_next_time_and_a_key_of_ones_own_works(deck: Deck) -> None:
    del deck.env["DECK_LANG"]
    first = deck.open()
    first.wait_for("One screen instead of five terminals")
    first.type("\x1b[20~\x1b[21~")  # F9, F10
    first.wait_for("Один экран вместо пяти терминалов")
    path = settings_of(deck)
    settled = {"tour": "seen", "theme": "textual-light", "language": "ru"}
    wait_until(lambda: path.exists() and json.loads(path.read_text()) == settled, "both settled")
    first.press("q")
    assert first.wait_exit() == 0
    path.write_text(json.dumps({**settled, "keys": {"app.quit": "ctrl+t"}}))
    second = deck.open()
    second.wait_for("Один экран вместо пяти терминалов")
    second.wait_for("^t Выход")
    second.press("ctrl+t")
    assert second.wait_exit() == 0


def test_a_broken_file_ends_the_program_with_its_place(deck: Deck) -> None:
    path = settings_of(deck)
    path.write_text('{"theme": "pink"}')
    terminal = deck.open()
    assert terminal.wait_exit() == 2
    terminal.wait_for_line("settings.json: theme: unknown value 'pink'")

"""Alt with a letter, held, or followed by another key or the mouse."""

from __future__ import annotations

import pytest
from textual.events import Key, MouseEvent
from textual.message import Message

from tui.terminal.alt_keys import AltKeyParser


def names(found: list[Message]) -> list[str]:
    """What each event is called."""
    return [one.key if isinstance(one, Key) else type(one).__name__ for one in found]


@pytest.mark.parametrize(
    ("typed", "expected"),
    [
        ("\x1bv\x1bv\x1bv", ["alt+v"] * 3),
        ("\x1bv\x1b[A", ["alt+v", "up"]),
        ("\x1b[A\x1bvq", ["up", "alt+v", "q"]),
        ("\x1bv\x1b[<35;10;10M", ["alt+v", "MouseMove"]),
        ("\x1bм\x1bм", ["alt+м", "alt+м"]),
        ("\x1bW\x1bW", ["alt+shift+w"] * 2),
        ("\x1bOP\x1b[15~", ["f1", "f5"]),
        ("\x1b\x7f\x1bf", ["ctrl+w", "ctrl+right"]),
        ("\x1bv\x1b[200~va\x1b[201~v", ["alt+v", "Paste", "v"]),
    ],
)
def test_what_follows_does_not_change_it(typed: str, expected: list[str]) -> None:
    assert names(list(AltKeyParser().feed(typed))) == expected


def test_escape_alone_is_escape_and_a_bare_letter_is_none_of_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    parser = AltKeyParser()
    assert names(list(parser.feed("\x1b"))) == []
    monkeypatch.setattr("textual._parser.get_time", lambda: float("inf"))
    assert names(list(parser.tick())) == ["escape"]
    assert names(list(parser.feed("v"))) == ["v"]


def test_the_mouse_is_told_where_it_is() -> None:
    (moved,) = AltKeyParser().feed("\x1b[<35;10;4M")
    assert isinstance(moved, MouseEvent)
    assert (moved.x, moved.y) == (9, 3)

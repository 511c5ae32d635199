"""The name that an agent gives itself is shown as a name, whatever it says."""

from __future__ import annotations

import pytest

from agents.server import LONGEST_NAME, shown_name


@pytest.mark.parametrize(
    ("given", "shown"),
    [
        ("claude", "claude"),
        ("Claude Desktop 1.2", "Claude-Desktop-1.2"),
        ("агент", "агент"),
        ("Deck: the emergency stop is released", "Deck-the-emergency-stop-is-released"),
        ("x” may drive until 12:00. Press “y", "x-may-drive-until-12-00.-Press-y"),
        ("\x1b[31m\u202e red\n\nline", "31m-red-line"),
        ("  ", ""),
        ("a" * 10_000, "a" * LONGEST_NAME),
    ],
)
def test_a_name_is_one_short_word(given: str, shown: str) -> None:
    assert shown_name(given) == shown

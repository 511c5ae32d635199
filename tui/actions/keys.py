"""The keys of actions that other screens than their own mention."""

from __future__ import annotations

from typing import NamedTuple


class Keys(NamedTuple):
    """What a screen needs to mention an action without importing its screen."""

    id: str
    """Binding id, as used in a keymap."""
    key: str
    """Default keys, in Textual's notation."""


WRITE_COMMAND = Keys("deck.command", "c")
"""Focuses the command line of the Deck."""

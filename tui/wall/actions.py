"""The actions of the wall."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Action

if TYPE_CHECKING:
    from tui.frame.screen import DeckScreen


class LeaveWall(Action["DeckScreen"]):
    """Go back to the Deck."""

    id = "wall.leave"
    key = "escape"
    title = N_("Deck")
    tooltip = N_("Back to the Deck, with all its keys.")
    footer = True
    palette = False

    @classmethod
    async def run(cls, target: DeckScreen) -> None:
        await target.deck.show_screen("deck")


WALL_ACTIONS = (LeaveWall,)

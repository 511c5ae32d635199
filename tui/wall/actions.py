"""The actions of the wall."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Announce, actions_of

if TYPE_CHECKING:
    from tui.frame.screen import DeckScreen

action: Announce[DeckScreen] = Announce()


@action("wall.leave", "escape", N_("Deck"), N_("Back to the Deck, with all its keys."), footer=True, palette=False)
async def leave_wall(dialog: DeckScreen) -> None:
    await dialog.deck.show_screen("deck")


WALL_ACTIONS = actions_of(__name__)

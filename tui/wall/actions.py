"""The actions of the wall."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Announce, actions_of

if TYPE_CHECKING:
    from tui.wall.screen import WallScreen

action: Announce[WallScreen] = Announce()


@action("wall.leave", "escape", N_("Deck"), N_("Back to the Deck, with all its keys."), footer=True, palette=False)
async def leave_wall(screen: WallScreen) -> None:
    await screen.deck.show_screen("deck")


@action(
    "wall.page",
    "v",
    N_("More panels"),
    N_("Show the panels that have no room on this page."),
    means="another view",
    footer=True,
    when=lambda screen: screen.grid.pages > 1,
)
def turn_page(screen: WallScreen) -> None:
    screen.grid.turn()


WALL_ACTIONS = actions_of(__name__)

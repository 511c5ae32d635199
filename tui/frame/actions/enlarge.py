"""One part of a screen in the place of all others: panels, a message, a log."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Announce

if TYPE_CHECKING:
    from tui.frame.screen import DeckScreen

action: Announce[DeckScreen] = Announce()


@action(
    "view.enlarge",
    "z,alt+z",
    N_("Enlarge"),
    N_("Give the whole screen to the part that has the focus; again or Esc: back."),
    means="enlarge",
    footer=True,
    when=lambda screen: screen.maximized is not None or screen.part_to_enlarge() is not None,
    shown=lambda screen: screen.maximized is not None,
    label=lambda screen: N_("Back to all") if screen.maximized is not None else N_("Enlarge"),
)
def enlarge(screen: DeckScreen) -> None:
    screen.toggle_enlarged()

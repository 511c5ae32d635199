"""One part of a screen in the place of all others: panels, a message, a log."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from text.i18n import N_
from tui.actions.action import Action

if TYPE_CHECKING:
    from textual.widget import Widget


class HasParts(Protocol):
    """The part of a screen that the action uses."""

    @property
    def maximized(self) -> Widget | None:
        """What is enlarged."""

    def part_to_enlarge(self) -> Widget | None:
        """Return the part that the key would enlarge."""

    def toggle_enlarged(self) -> None:
        """Enlarge it, or show all parts again."""


class Enlarge(Action[HasParts]):
    """Give the whole screen to one of its parts, and back."""

    id = "view.enlarge"
    key = "z,я,alt+z"
    title = N_("Enlarge")
    means = "enlarge"
    tooltip = N_("Give the whole screen to the part that has the focus; again or Esc: back.")
    footer = True

    @classmethod
    def possible(cls, target: HasParts) -> bool | None:
        """Only with a part that can be enlarged, or is."""
        return target.maximized is not None or target.part_to_enlarge() is not None

    @classmethod
    def shown(cls, target: HasParts) -> bool:
        """Only as the way back: the keys of the screen itself need the room."""
        return target.maximized is not None

    @classmethod
    def label(cls, target: HasParts) -> str:
        """Named after what it would do now."""
        return N_("Back to all") if target.maximized is not None else cls.title

    @classmethod
    async def run(cls, target: HasParts) -> None:
        target.toggle_enlarged()

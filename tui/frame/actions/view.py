"""The robot in 3D, beside the screen."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from text.i18n import N_
from tui.actions.action import Action

if TYPE_CHECKING:
    from tui.frame.host import Host


class OpenView(Action["Host"]):
    """Open the viewer, or say where it is open."""

    id = "view.open"
    key = "alt+w,alt+ц"
    title = N_("3D")
    tooltip = N_("The robot in 3D, in a window of its own or in a browser: Rerun.")
    priority = True

    @classmethod
    def possible(cls, target: Host) -> bool | None:
        """Only while a robot is shown, not a recording of one."""
        return target.feed.link is not None and target.feed.replay is None

    @classmethod
    async def run(cls, target: Host) -> None:
        target.view.open()


class OnDeck(Protocol):
    """The part of a screen that leads to the app."""

    @property
    def deck(self) -> Host:
        """The app."""


class OpenViewHere(Action[OnDeck]):
    """The viewer on a screen that shows where things are: another view of the same."""

    key = "v,м"
    title = OpenView.title
    means = "another view"
    tooltip = OpenView.tooltip
    footer = True
    palette = False

    @classmethod
    def possible(cls, target: OnDeck) -> bool | None:
        return OpenView.possible(target.deck)

    @classmethod
    async def run(cls, target: OnDeck) -> None:
        await OpenView.run(target.deck)

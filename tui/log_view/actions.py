"""What can be done with lines that come in, on each screen that shows some.

A screen makes one its own by a subclass with an id, and with other words where it needs them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Protocol, TypeVar

from text.i18n import N_
from tui.actions.action import Action

if TYPE_CHECKING:
    from tui.log_view.pane import LogPane


class ShowsLines(Protocol):
    """What these actions need of a screen."""

    @property
    def pane(self) -> LogPane:
        """The lines."""


Shown = TypeVar("Shown", bound=ShowsLines)


class PauseLines(Action[Shown]):
    """Stand still, or follow."""

    key = "p,з"
    title = N_("Pause")
    footer = True
    from_elsewhere = True

    @classmethod
    def label(cls, target: Shown) -> str:
        """By what it would do now."""
        return cls.title if target.pane.view.following else N_("Resume")

    @classmethod
    async def run(cls, target: Shown) -> None:
        """Do the other of the two."""
        target.pane.view.toggle_following()


class SearchLines(Action[Shown]):
    """Search."""

    key = "slash,ctrl+f"
    title = N_("Search")
    priority = True
    from_elsewhere = True

    @classmethod
    def possible(cls, target: Shown) -> bool | None:
        """Not where one is asked already: there a slash is a slash."""
        return super().possible(target) and not target.pane.prompt.kind

    @classmethod
    async def run(cls, target: Shown) -> None:
        """Ask what for."""
        target.pane.search()


class FindLine(Action[Shown]):
    """Go to a line that was found."""

    step: ClassVar[int]

    @classmethod
    async def run(cls, target: Shown) -> None:
        """Point at it."""
        target.pane.find(cls.step)


class NextLine(FindLine[Shown]):
    """The next found line."""

    key = "n,т"
    title = N_("Next")
    step = 1


class PreviousLine(FindLine[Shown]):
    """The previous found line."""

    key = "N,Т"
    title = N_("Previous")
    step = -1


class FoldLines(Action[Shown]):
    """Fold long lines, or not."""

    key = "w,ц"
    title = N_("Fold")
    tooltip = N_("Fold long lines, or show one row of each: left and right shift it.")
    footer = True
    from_elsewhere = True

    @classmethod
    async def run(cls, target: Shown) -> None:
        """Do the other of the two."""
        target.pane.view.set_fold(not target.pane.view.fold)


class CopyLines(Action[Shown]):
    """Copy the lines chosen."""

    key = "y,н"
    title = N_("Copy")
    tooltip = N_("Copy the lines chosen to the clipboard of your terminal.")
    footer = True

    @classmethod
    async def run(cls, target: Shown) -> None:
        """Copy."""
        target.pane.copy()


class SaveLines(Action[Shown]):
    """Write lines to a file."""

    key = "W,Ц"
    title = N_("Write")
    tooltip = N_("Write the lines chosen, else all shown, to a file.")
    footer = True

    @classmethod
    async def run(cls, target: Shown) -> None:
        """Ask for its name."""
        target.pane.save()

"""The actions of every screen that shows incoming lines.

A screen subclasses each one with its own id, and with other texts where it needs them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Protocol, TypeVar

from text.i18n import N_
from tui.actions.action import Action

if TYPE_CHECKING:
    from tui.log_view.pane import LogPane


class ShowsLines(Protocol):
    """The part of a screen that these actions use."""

    @property
    def pane(self) -> LogPane:
        """The lines."""


Shown = TypeVar("Shown", bound=ShowsLines)


class PauseLines(Action[Shown]):
    """Pause, or follow."""

    key = "p,з"
    title = N_("Pause")
    footer = True
    from_elsewhere = True

    @classmethod
    def label(cls, target: Shown) -> str:
        """Named after what it would do now."""
        return cls.title if target.pane.view.following else N_("Resume")

    @classmethod
    async def run(cls, target: Shown) -> None:
        target.pane.view.toggle_following()


class SearchLines(Action[Shown]):
    """Search the lines."""

    key = "slash,ctrl+f"
    title = N_("Search")
    priority = True
    from_elsewhere = True

    @classmethod
    def possible(cls, target: Shown) -> bool | None:
        """Not while text is being entered: there a slash is typed."""
        return super().possible(target) and not target.pane.prompt.kind

    @classmethod
    async def run(cls, target: Shown) -> None:
        target.pane.search()


class FindLine(Action[Shown]):
    """Go to a match."""

    step: ClassVar[int]

    @classmethod
    async def run(cls, target: Shown) -> None:
        target.pane.find(cls.step)


class NextLine(FindLine[Shown]):
    """Go to the next match."""

    key = "n,т"
    title = N_("Next")
    step = 1


class PreviousLine(FindLine[Shown]):
    """Go to the previous match."""

    key = "N,Т"
    title = N_("Previous")
    step = -1


class FoldLines(Action[Shown]):
    """Wrap long lines, or not."""

    key = "w,ц"
    title = N_("Wrap")
    tooltip = N_("Wrap long lines, or show one row of each: left and right shift it.")
    footer = True
    from_elsewhere = True

    @classmethod
    async def run(cls, target: Shown) -> None:
        target.pane.view.set_fold(not target.pane.view.fold)


class CopyLines(Action[Shown]):
    """Copy the chosen lines."""

    key = "y,н"
    title = N_("Copy")
    tooltip = N_("Copy the selected lines to the clipboard of your terminal.")
    footer = True

    @classmethod
    async def run(cls, target: Shown) -> None:
        target.pane.copy()


class SaveLines(Action[Shown]):
    """Write lines to a file."""

    key = "W,Ц"
    title = N_("Write")
    tooltip = N_("Write the selected lines to a file, or all lines shown if none is selected.")
    footer = True

    @classmethod
    async def run(cls, target: Shown) -> None:
        target.pane.save()

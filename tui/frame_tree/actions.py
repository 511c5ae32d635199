"""The actions of the Frames screen; each letter also works as the Cyrillic one on its key."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from text.i18n import N_
from tui.actions.action import Action
from tui.frame.actions.view import OpenViewHere

if TYPE_CHECKING:
    from textual.widget import Widget
    from textual.widgets import Input


class FramesTarget(Protocol):
    """The part of the Frames screen that its actions use."""

    @property
    def chosen(self) -> str:
        """The frame at the cursor, empty if there is none."""

    @property
    def has_frames(self) -> bool:
        """Whether there is a tree."""

    @property
    def filter(self) -> Input:
        """The input of the filter."""

    @property
    def focused(self) -> Widget | None:
        """The widget that has the keys."""

    @property
    def has_findings(self) -> bool:
        """Whether anything is wrong."""

    def focus_filter(self) -> None:
        """Focus the filter."""

    def relate(self) -> None:
        """Show frames relative to the one at the cursor, or to the root again."""

    def turn_round(self) -> None:
        """Show the one frame in the other, or the other way round."""

    def go_to_finding(self, step: int) -> None:
        """Go to the next frame that something is wrong with, or to the one before."""

    def copy_pair(self) -> None:
        """Copy the transform that is shown."""


class FramesAction(Action[FramesTarget]):
    """An action on the frame at the cursor."""

    @classmethod
    def possible(cls, target: FramesTarget) -> bool | None:
        """Only with a frame at the cursor."""
        return True if target.chosen else None


class RelativeTo(FramesAction):
    """Show others relative to this frame."""

    id = "frames.relative"
    key = "enter"
    title = N_("Relative")
    tooltip = N_("Show the other frames relative to this one; again: relative to the root.")
    footer = True

    @classmethod
    async def run(cls, target: FramesTarget) -> None:
        target.relate()


class _Findings(FramesAction):
    """An action on the findings."""

    @classmethod
    def possible(cls, target: FramesTarget) -> bool | None:
        """Only if anything is wrong."""
        return True if target.has_findings else None


class NextFinding(_Findings):
    """Go to the next frame with a finding."""

    id = "frames.next"
    key = "n,т"
    title = N_("Next finding")
    means = "next"
    tooltip = N_("Go to the next frame that something is wrong with.")
    footer = True

    @classmethod
    def shown(cls, target: FramesTarget) -> bool:
        """Only if there is one: its room is for others otherwise."""
        return target.has_findings

    @classmethod
    def label(cls, target: FramesTarget) -> str:
        """Short, for the narrowest footer."""
        del target
        return N_("Finding")

    @classmethod
    async def run(cls, target: FramesTarget) -> None:
        target.go_to_finding(1)


class PreviousFinding(_Findings):
    """Go to the previous frame with a finding."""

    id = "frames.previous"
    key = "N,Т"
    title = N_("Previous finding")
    means = "previous"
    tooltip = N_("Go to the frame before this one that something is wrong with.")

    @classmethod
    async def run(cls, target: FramesTarget) -> None:
        target.go_to_finding(-1)


class CopyTransform(FramesAction):
    """Copy the transform as text."""

    id = "frames.copy"
    key = "y,н"
    title = N_("Copy")
    tooltip = N_("Copy the transform that is shown, with the command that publishes it.")
    footer = True

    @classmethod
    async def run(cls, target: FramesTarget) -> None:
        target.copy_pair()


class FilterFrames(FramesAction):
    """Filter the tree."""

    id = "frames.filter"
    key = "slash,ctrl+f"
    title = N_("Filter")
    means = "find"
    tooltip = N_("Show only frames whose name or publisher has the words that you type.")
    footer = True
    priority = True
    from_elsewhere = True

    @classmethod
    def possible(cls, target: FramesTarget) -> bool | None:
        """Not in the filter itself, where a slash is typed, nor without frames."""
        return target.has_frames and target.focused is not target.filter

    @classmethod
    async def run(cls, target: FramesTarget) -> None:
        target.focus_filter()


class FramesIn3D(OpenViewHere):
    """The viewer, by the letter for another view."""

    id = "frames.view"


class OtherWayRound(FramesAction):
    """Show the inverse."""

    id = "frames.inverse"
    key = "alt+x,alt+ч"
    title = N_("Other way")
    tooltip = N_("Show the first frame in the second, or the second in the first.")
    footer = True

    @classmethod
    async def run(cls, target: FramesTarget) -> None:
        target.turn_round()


FRAMES_ACTIONS = (RelativeTo, NextFinding, PreviousFinding, CopyTransform, FilterFrames, FramesIn3D, OtherWayRound)

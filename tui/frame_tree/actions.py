"""The actions of the Frames screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Announce, actions_of
from tui.frame.actions.view import open_view

if TYPE_CHECKING:
    from tui.frame_tree.screen import FramesScreen

action: Announce[FramesScreen] = Announce()


def _has_frames(screen: FramesScreen) -> bool | None:
    return True if screen.chosen else None


@action(
    "frames.relative",
    "enter",
    N_("Relative"),
    N_("Show the other frames relative to this one; again: relative to the root."),
    footer=True,
    when=_has_frames,
)
def relative_to(screen: FramesScreen) -> None:
    screen.relate()


def _has_findings(screen: FramesScreen) -> bool | None:
    return True if screen.findings else None


@action(
    "frames.next",
    "n",
    N_("Next finding"),
    N_("Go to the next frame that something is wrong with."),
    means="next",
    footer=True,
    when=_has_findings,
    shown=lambda screen: bool(screen.findings),
    label=lambda _: N_("Finding"),
)
def next_finding(screen: FramesScreen) -> None:
    screen.go_to_finding(1)


@action(
    "frames.previous",
    "N",
    N_("Previous finding"),
    N_("Go to the frame before this one that something is wrong with."),
    means="previous",
    when=_has_findings,
)
def previous_finding(screen: FramesScreen) -> None:
    screen.go_to_finding(-1)


@action(
    "frames.copy",
    "y",
    N_("Copy"),
    N_("Copy the transform that is shown, with the command that publishes it."),
    footer=True,
    when=_has_frames,
)
def copy_transform(screen: FramesScreen) -> None:
    screen.copy_pair()


@action(
    "frames.filter",
    "slash,ctrl+f",
    N_("Filter"),
    N_("Show only frames whose name or publisher has the words that you type."),
    means="find",
    footer=True,
    priority=True,
    anywhere=True,
    when=lambda screen: bool(screen.frame_tree.frames) and screen.focused is not screen.filter,
)
def filter_frames(screen: FramesScreen) -> None:
    screen.set_focus(screen.filter)


@action(
    "frames.view",
    "v",
    open_view.title,
    open_view.tooltip,
    means="another view",
    footer=True,
    palette=False,
    when=lambda screen: open_view.possible(screen.deck),
)
async def frames_in_3d(screen: FramesScreen) -> None:
    await open_view.run(screen.deck)


@action(
    "frames.inverse",
    "alt+x",
    N_("Other way"),
    N_("Show the first frame in the second, or the second in the first."),
    footer=True,
    when=_has_frames,
)
def other_way_round(screen: FramesScreen) -> None:
    screen.turned = not screen.turned
    screen.show_pair()


FRAMES_ACTIONS = actions_of(__name__)

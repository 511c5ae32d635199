"""The actions for driving with keys: one opens the panel, the others are the panel's."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Protocol

from text.i18n import N_
from text.robot import robot
from tui.actions.action import Action, Announce, actions_of

if TYPE_CHECKING:
    from tui.session.feed import Feed
    from tui.teleop.widget import TeleopPanel


class Move(Enum):
    """What a key asks for."""

    FORWARD = "forward"
    BACK = "back"
    LEFT = "left"
    RIGHT = "right"


class CanDrive(Protocol):
    """The screen that opens the panel."""

    @property
    def feed(self) -> Feed: ...

    async def open_teleop(self) -> None: ...


action: Announce[TeleopPanel] = Announce()
on_screen: Announce[CanDrive] = Announce()


@on_screen(
    "deck.teleop",
    "t",
    N_("Drive"),
    N_("Drive with the arrow keys or W A S D while held; releasing them stops. Escape closes."),
    means="drive",
    footer=True,
    anywhere=True,
    when=lambda screen: bool(robot().keys) and screen.feed.link is not None and screen.feed.replay is None,
)
async def open_teleop(screen: CanDrive) -> None:
    await screen.open_teleop()


@action("teleop.close", "escape,t", N_("Close"), N_("Stop, and leave driving."), means="drive", footer=True)
def close_teleop(panel: TeleopPanel) -> None:
    panel.close()


@action(
    "teleop.faster",
    "plus,equals_sign",
    N_("Faster"),
    N_("Drive 0.05 m/s faster from the next press on, up to 0.5 m/s."),
    footer=True,
)
def drive_faster(panel: TeleopPanel) -> None:
    panel.change_limits(panel.limits.faster(1))


@action(
    "teleop.slower",
    "minus,underscore",
    N_("Slower"),
    N_("Drive 0.05 m/s slower from the next press on."),
    footer=True,
)
def drive_slower(panel: TeleopPanel) -> None:
    panel.change_limits(panel.limits.faster(-1))


@action(
    "teleop.sharper",
    "right_square_bracket,ъ",
    N_("Sharper"),
    N_("Steer 0.05 rad more from the next press on, up to 0.5 rad."),
)
def sharper(panel: TeleopPanel) -> None:
    panel.change_limits(panel.limits.sharper(1))


@action("teleop.wider", "left_square_bracket,х", N_("Wider"), N_("Steer 0.05 rad less from the next press on."))
def wider(panel: TeleopPanel) -> None:
    panel.change_limits(panel.limits.sharper(-1))


def _moving(move: Move, key: str, title: str, tooltip: str) -> Action[TeleopPanel]:
    @action(f"teleop.{move.value}", key, title, tooltip, footer=True, palette=False)
    def drive(panel: TeleopPanel) -> None:
        panel.press(move)

    return drive


MOVES = {
    _moving(move, *said): move
    for move, said in {
        Move.FORWARD: (
            *("up,w", N_("Forward")),
            N_("Forward while it is held; press it again in a curve to go straight on."),
        ),
        Move.BACK: (
            *("down,s", N_("Back")),
            N_("Backwards while it is held; press it again in a curve to go straight back."),
        ),
        Move.LEFT: ("left,a", N_("Left"), N_("Left while it is held; a moving robot goes on in a curve.")),
        Move.RIGHT: ("right,d", N_("Right"), N_("Right while it is held; a moving robot goes on in a curve.")),
    }.items()
}
"""The actions that drive while their key is held; a click counts as one short press."""
TELEOP_ACTIONS = [each for each in actions_of(__name__) if each is not open_teleop]

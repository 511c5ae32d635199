"""The actions for driving with keys; each letter also works as the Cyrillic one on its key."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Protocol

from text.i18n import N_
from tui.actions.action import Action
from tui.teleop.keys import Move

if TYPE_CHECKING:
    from tui.session.feed import Feed
    from tui.teleop.keys import TeleopLimits


class CanDrive(Protocol):
    """A screen that can be used for driving."""

    @property
    def feed(self) -> Feed:
        """The session."""

    async def open_teleop(self) -> None:
        """Open the panel, or focus it."""


class OpenTeleop(Action["CanDrive"]):
    """Drive the robot with keys."""

    id = "deck.teleop"
    key = "t,е"
    title = N_("Drive")
    means = "drive"
    tooltip = N_("Drive with the arrow keys or W A S D while held; releasing them stops. Escape closes.")
    footer = True
    from_elsewhere = True

    @classmethod
    def possible(cls, target: CanDrive) -> bool | None:
        """Only with a robot: not in a recording, and not after the session has ended."""
        return target.feed.link is not None and target.feed.replay is None

    @classmethod
    async def run(cls, target: CanDrive) -> None:
        await target.open_teleop()


class DrivenByKeys(Protocol):
    """The panel that the keys drive."""

    limits: TeleopLimits
    """Speed and steering of the keys, from the next press on."""

    def press(self, move: Move) -> None:
        """Press a key."""

    def close(self) -> None:
        """Stop driving."""


class TeleopAction(Action["DrivenByKeys"]):
    """An action of the panel."""


class CloseTeleop(TeleopAction):
    """Stop driving."""

    id = "teleop.close"
    key = "escape,t,е"
    title = N_("Close")
    means = "drive"
    tooltip = N_("Stop, and leave driving.")
    footer = True

    @classmethod
    async def run(cls, target: DrivenByKeys) -> None:
        target.close()


class DriveFaster(TeleopAction):
    """Raise the speed of the keys."""

    id = "teleop.faster"
    key = "plus,equals_sign"
    title = N_("Faster")
    tooltip = N_("Drive 0.05 m/s faster from the next press on, up to 0.5 m/s.")
    footer = True
    steps = 1

    @classmethod
    async def run(cls, target: DrivenByKeys) -> None:
        """Change the speed of the keys."""
        target.limits = target.limits.faster(cls.steps)


class DriveSlower(DriveFaster):
    """Lower the speed of the keys."""

    id = "teleop.slower"
    key = "minus,underscore"
    title = N_("Slower")
    tooltip = N_("Drive 0.05 m/s slower from the next press on.")
    steps = -1


class MoveAction(TeleopAction):
    """A key that drives while it is held; a click counts as one short press."""

    move: ClassVar[Move]
    footer = True
    palette = False

    @classmethod
    async def run(cls, target: DrivenByKeys) -> None:
        target.press(cls.move)


class DriveForward(MoveAction):
    """Forward."""

    id = "teleop.forward"
    key = "up,w,ц"
    title = N_("Forward")
    tooltip = N_("Forward while it is held; press it again in a curve to go straight on.")
    move = Move.FORWARD


class DriveBack(MoveAction):
    """Back."""

    id = "teleop.back"
    key = "down,s,ы"
    title = N_("Back")
    tooltip = N_("Backwards while it is held; press it again in a curve to go straight back.")
    move = Move.BACK


class SteerLeft(MoveAction):
    """To the left."""

    id = "teleop.left"
    key = "left,a,ф"
    title = N_("Left")
    tooltip = N_("Left while it is held; a moving robot goes on in a curve.")
    move = Move.LEFT


class SteerRight(MoveAction):
    """To the right."""

    id = "teleop.right"
    key = "right,d,в"
    title = N_("Right")
    tooltip = N_("Right while it is held; a moving robot goes on in a curve.")
    move = Move.RIGHT


class Sharper(TeleopAction):
    """Steer more sharply."""

    id = "teleop.sharper"
    key = "right_square_bracket,ъ"
    title = N_("Sharper")
    tooltip = N_("Steer 0.05 rad more from the next press on, up to 0.5 rad.")
    steps = 1

    @classmethod
    async def run(cls, target: DrivenByKeys) -> None:
        """Change the steering of the keys."""
        target.limits = target.limits.sharper(cls.steps)


class Wider(Sharper):
    """Steer less sharply."""

    id = "teleop.wider"
    key = "left_square_bracket,х"
    title = N_("Wider")
    tooltip = N_("Steer 0.05 rad less from the next press on.")
    steps = -1


TELEOP_ACTIONS = (
    CloseTeleop,
    DriveFaster,
    DriveSlower,
    DriveForward,
    DriveBack,
    SteerLeft,
    SteerRight,
    Sharper,
    Wider,
)

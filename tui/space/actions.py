"""The actions of the Space screen; each letter also works as the Cyrillic one on its key."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from text.i18n import N_
from tui.actions.action import Action
from tui.frame.actions.view import OpenViewHere

if TYPE_CHECKING:
    from collections.abc import Awaitable


class SpaceTarget(Protocol):
    """The part of the Space screen that its actions use."""

    @property
    def armed(self) -> bool:
        """Whether a goal or an initial pose is aimed."""

    @property
    def has_layers(self) -> bool:
        """Whether there is anything to show or hide."""

    def next_angle(self) -> None:
        """Look from above, from the side, or in perspective."""

    def fit(self) -> None:
        """Show everything."""

    def choose_follow(self) -> None:
        """Ask which frame stays in the middle."""

    def choose_fixed(self) -> None:
        """Ask in which frame everything is drawn."""

    def toggle_layer(self) -> None:
        """Show or hide the chosen layer."""

    def only_layer(self) -> None:
        """Show only the chosen layer."""

    def all_layers(self) -> None:
        """Show all layers."""

    def arm_goal(self) -> None:
        """Begin to aim a goal."""

    def arm_initial_pose(self) -> None:
        """Begin to aim an initial pose."""

    def publish_aim(self) -> Awaitable[None]:
        """Publish what is aimed."""

    def disarm(self) -> None:
        """Aim at nothing any more."""


class SpaceAction(Action[SpaceTarget]):
    """An action on the picture of space."""


class _ArmedAction(SpaceAction):
    """An action on what is aimed."""

    palette = False
    footer = True

    @classmethod
    def possible(cls, target: SpaceTarget) -> bool | None:
        """Only while something is aimed."""
        return target.armed


class PublishAim(_ArmedAction):
    """Publish what is aimed."""

    id = "space.publish"
    key = "enter"
    title = N_("Publish")
    tooltip = N_("Publish the goal or the initial pose where the cross-hair is.")

    @classmethod
    async def run(cls, target: SpaceTarget) -> None:
        await target.publish_aim()


class Disarm(_ArmedAction):
    """Aim at nothing any more."""

    id = "space.disarm"
    key = "escape"
    title = N_("Disarm")
    tooltip = N_("Stop aiming, and publish nothing.")

    @classmethod
    async def run(cls, target: SpaceTarget) -> None:
        target.disarm()


class NextAngle(SpaceAction):
    """Look from elsewhere."""

    id = "space.angle"
    key = "alt+v,alt+м"
    title = N_("Angle")
    tooltip = N_("Look from above, from the side, or in perspective, which Ctrl+arrows turn.")
    footer = True
    from_elsewhere = True

    @classmethod
    async def run(cls, target: SpaceTarget) -> None:
        target.next_angle()


class OpenIn3D(OpenViewHere):
    """The viewer, by the letter for another view."""

    id = "space.view"


class FitAll(SpaceAction):
    """Show everything."""

    id = "space.fit"
    key = "home"
    title = N_("Fit")
    tooltip = N_("Move the camera so that everything is seen, and follow no frame.")
    footer = True
    from_elsewhere = True

    @classmethod
    async def run(cls, target: SpaceTarget) -> None:
        target.fit()


class FollowFrame(SpaceAction):
    """Keep a frame in the middle."""

    id = "space.follow"
    key = "alt+t,alt+е"
    title = N_("Follow")
    tooltip = N_("Choose a frame that stays in the middle of the picture.")
    footer = True

    @classmethod
    async def run(cls, target: SpaceTarget) -> None:
        target.choose_follow()


class FixedFrame(SpaceAction):
    """Choose the fixed frame."""

    id = "space.fixed"
    key = "alt+r,alt+к"
    title = N_("Fixed frame")
    tooltip = N_("Choose the frame in which everything is drawn, and goals are given.")

    @classmethod
    async def run(cls, target: SpaceTarget) -> None:
        target.choose_fixed()


class _LayerAction(SpaceAction):
    """An action that needs layers."""

    @classmethod
    def possible(cls, target: SpaceTarget) -> bool | None:
        return target.has_layers


class ToggleLayer(_LayerAction):
    """Show or hide a layer."""

    id = "space.layer"
    key = "m,ь"
    title = N_("Layer")
    means = "leave out"
    tooltip = N_("Show or hide the selected layer; a hidden one is not subscribed to.")
    footer = True

    @classmethod
    async def run(cls, target: SpaceTarget) -> None:
        target.toggle_layer()


class OnlyLayer(_LayerAction):
    """Show one layer only."""

    id = "space.only"
    key = "o,щ"
    title = N_("Only this")
    means = "only this"
    tooltip = N_("Hide all layers but the selected one.")

    @classmethod
    async def run(cls, target: SpaceTarget) -> None:
        target.only_layer()


class AllLayers(_LayerAction):
    """Show all layers."""

    id = "space.all"
    key = "a,ф"
    title = N_("All layers")
    means = "all"
    tooltip = N_("Show all layers.")

    @classmethod
    async def run(cls, target: SpaceTarget) -> None:
        target.all_layers()


class ArmGoal(SpaceAction):
    """Begin to aim a goal."""

    id = "space.goal"
    key = "alt+g,alt+п"
    title = N_("Goal")
    tooltip = N_("Aim a goal for navigation: press and drag the mouse, or arrows, Ctrl+arrows and Enter.")
    footer = True

    @classmethod
    async def run(cls, target: SpaceTarget) -> None:
        target.arm_goal()


class ArmInitialPose(SpaceAction):
    """Begin to aim an initial pose."""

    id = "space.initial"
    key = "alt+i,alt+ш"
    title = N_("Initial pose")
    tooltip = N_("Aim where the robot is now, for localization on a map, as a goal is aimed.")

    @classmethod
    async def run(cls, target: SpaceTarget) -> None:
        target.arm_initial_pose()


SPACE_ACTIONS = (
    PublishAim,
    Disarm,
    NextAngle,
    OpenIn3D,
    FitAll,
    FollowFrame,
    ToggleLayer,
    ArmGoal,
    OnlyLayer,
    AllLayers,
    FixedFrame,
    ArmInitialPose,
)

"""The actions of the Space screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_, _
from tui.actions.action import Announce, actions_of
from tui.frame.actions.view import open_view
from tui.space.aiming import GOAL, INITIAL

if TYPE_CHECKING:
    from tui.space.screen import SpaceScreen

action: Announce[SpaceScreen] = Announce()


@action(
    "space.publish",
    "enter",
    N_("Publish"),
    N_("Publish the goal or the initial pose where the cross-hair is."),
    footer=True,
    palette=False,
    when=lambda screen: screen.armed,
)
def publish_aim(screen: SpaceScreen) -> None:
    screen.publish_aim()


@action(
    "space.disarm",
    "escape",
    N_("Disarm"),
    N_("Stop aiming, and publish nothing."),
    footer=True,
    palette=False,
    when=lambda screen: screen.armed,
)
def disarm(screen: SpaceScreen) -> None:
    screen.disarm()


@action(
    "space.view",
    "v",
    open_view.title,
    open_view.tooltip,
    means="another view",
    footer=True,
    palette=False,
    when=lambda screen: open_view.possible(screen.deck),
)
async def open_in_3d(screen: SpaceScreen) -> None:
    await open_view.run(screen.deck)


@action(
    "space.fit",
    "home",
    N_("Fit"),
    N_("Move the camera so that everything is seen, and follow no frame."),
    footer=True,
    anywhere=True,
)
def fit_all(screen: SpaceScreen) -> None:
    screen.fit()


@action(
    "space.follow", "alt+t", N_("Follow"), N_("Choose a frame that stays in the middle of the picture."), footer=True
)
def follow_frame(screen: SpaceScreen) -> None:
    def take(answer: str | None) -> None:
        if answer:
            screen.stage.follow_frame(answer.strip())
            screen.view.fits = not screen.stage.follow
            screen.show(by_user=True)

    screen.ask_frame(lambda: _("Follow a frame"), lambda: _("no frame"), take)


@action(
    "space.layer",
    "m",
    N_("Layer"),
    N_("Show or hide the selected layer; a hidden one is not subscribed to."),
    means="leave out",
    footer=True,
)
def toggle_layer(screen: SpaceScreen) -> None:
    screen.toggle_layer()


@action(
    "space.goal",
    "alt+g",
    N_("Goal"),
    N_("Aim a goal for navigation: press and drag the mouse, or arrows, Ctrl+arrows and Enter."),
    footer=True,
)
def arm_goal(screen: SpaceScreen) -> None:
    screen.arm(GOAL)


@action("space.only", "o", N_("Only this"), N_("Hide all layers but the selected one."), means="only this")
def only_layer(screen: SpaceScreen) -> None:
    chosen = screen.layer_rows.chosen
    screen.stage.show_frames = chosen == "frames"
    for layer in screen.stage.layers:
        layer.on = layer.topic == chosen
        if not layer.on:
            layer.forget()
    screen.layers_changed()


@action(
    "space.all", "a", N_("All layers"), N_("Show all layers."), means="all", when=lambda screen: screen.is_mounted
)
def all_layers(screen: SpaceScreen) -> None:
    screen.stage.show_frames = True
    for layer in screen.stage.layers:
        layer.on = True
    screen.layers_changed()


@action(
    "space.fixed",
    "alt+r",
    N_("Fixed frame"),
    N_("Choose the frame in which everything is drawn, and goals are given."),
)
def fixed_frame(screen: SpaceScreen) -> None:
    def take(answer: str | None) -> None:
        if answer:
            screen.disarm()
            screen.stage.wanted_fixed = answer.strip()
            screen.fit()

    screen.ask_frame(lambda: _("Fixed frame"), lambda: _("the robot's root"), take)


@action(
    "space.initial",
    "alt+i",
    N_("Initial pose"),
    N_("Aim where the robot is now, for localization on a map, as a goal is aimed."),
)
def arm_initial_pose(screen: SpaceScreen) -> None:
    screen.arm(INITIAL)


SPACE_ACTIONS = actions_of(__name__)

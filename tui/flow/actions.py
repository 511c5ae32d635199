"""The actions of the Flow screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Announce, actions_of
from tui.flow.chains import Lane

if TYPE_CHECKING:
    from tui.flow.screen import FlowScreen

action: Announce[FlowScreen] = Announce()


@action(
    "flow.older",
    "n",
    N_("Older"),
    N_("Go to the utterance before this one."),
    means="next",
    footer=True,
    anywhere=True,
    when=lambda screen: True if screen.neighbour(1) else None,
)
def older_chain(screen: FlowScreen) -> None:
    screen.go(1)


@action(
    "flow.newer",
    "N",
    N_("Newer"),
    N_("Go to the utterance after this one."),
    means="previous",
    anywhere=True,
    when=lambda screen: True if screen.neighbour(-1) else None,
)
def newer_chain(screen: FlowScreen) -> None:
    screen.go(-1)


@action(
    "flow.pause",
    "p",
    N_("Pause"),
    N_("Freeze the timeline, or show what has happened since."),
    footer=True,
    anywhere=True,
    label=lambda screen: N_("Resume") if screen.paused else N_("Pause"),
)
def pause_flow(screen: FlowScreen) -> None:
    screen.toggle_pause()


def _chosen(screen: FlowScreen) -> bool | None:
    """Only if a step is chosen."""
    return True if screen.chosen_step else None


@action(
    "flow.hide",
    "m",
    N_("Hide"),
    N_("Hide all steps of the same kind as the selected one: microphone, brain, wheels..."),
    means="leave out",
    footer=True,
    when=_chosen,
)
def hide_lane(screen: FlowScreen) -> None:
    if screen.chosen_step:
        screen.toggle_lane(screen.chosen_step.lane)


@action(
    "flow.all",
    "a",
    N_("Show all"),
    N_("Show every step again, without the logs of other nodes."),
    means="all",
    footer=True,
    anywhere=True,
)
def show_all_lanes(screen: FlowScreen) -> None:
    screen.show_all()


@action(
    "flow.logs",
    "F",
    N_("Other logs"),
    N_("Show or hide what other nodes wrote into their logs meanwhile."),
    means="how much of the log",
    footer=True,
    anywhere=True,
)
def other_logs(screen: FlowScreen) -> None:
    screen.toggle_lane(Lane.LOG)


@action(
    "flow.copy",
    "y",
    N_("Copy"),
    N_("Copy the steps of this utterance, with their delays, as text."),
    footer=True,
    when=_chosen,
)
def copy_chain(screen: FlowScreen) -> None:
    screen.copy_chain()


FLOW_ACTIONS = actions_of(__name__)

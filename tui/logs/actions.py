"""The actions of the Logs screen."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from launcher.status import Severity
from text.i18n import N_
from tui.actions.action import Announce, actions_of
from tui.log_view.actions import folding, pausing, searching, taking

if TYPE_CHECKING:
    from tui.logs.screen import LogsScreen

action: Announce[LogsScreen] = Announce()


pausing("logs.follow")
searching("logs", footer=True)


@action(
    "logs.only_found",
    "f",
    N_("Only found"),
    N_("Show only the lines that contain the search text."),
    means="only",
    anywhere=True,
    when=lambda screen: True if screen.pane.view.log_filter.search else None,
)
def only_found(screen: LogsScreen) -> None:
    chosen = screen.pane.view.log_filter
    screen.choose(replace(chosen, only_found=not chosen.only_found))


@action(
    "logs.severity",
    "F",
    N_("Severity"),
    N_("Hide the least severe lines that are shown; after FATAL all are shown again."),
    means="how much of the log",
    footer=True,
    anywhere=True,
)
def raise_severity(screen: LogsScreen) -> None:
    screen.choose(screen.pane.view.log_filter.next_minimum())


@action(
    "logs.nodes",
    "I",
    N_("Nodes"),
    N_("Go to the list of nodes, where Enter mutes or unmutes one."),
    means="nodes behind it",
    footer=True,
    anywhere=True,
)
def show_nodes(screen: LogsScreen) -> None:
    screen.toggle_nodes()


@action(
    "logs.mute",
    "m",
    N_("Mute"),
    N_("Hide the lines of the selected node, or show them again."),
    means="leave out",
    footer=True,
    when=lambda screen: True if screen.chosen_node else None,
)
def mute_in_log(screen: LogsScreen) -> None:
    if screen.chosen_node:
        screen.choose(screen.pane.view.log_filter.toggled(screen.chosen_node))


@action(
    "logs.alone",
    "o",
    N_("Only this"),
    N_("Show only the lines of the selected node; press again to undo."),
    means="only this",
    footer=True,
    when=lambda screen: True if screen.chosen_node else None,
)
def hear_one_in_log(screen: LogsScreen) -> None:
    if screen.chosen_node:
        screen.choose(screen.pane.view.log_filter.alone(screen.chosen_node))


@action(
    "logs.all",
    "a",
    N_("All nodes"),
    N_("Show the lines of all nodes, at every severity."),
    means="all",
    anywhere=True,
)
def hear_all_in_log(screen: LogsScreen) -> None:
    screen.choose(replace(screen.pane.view.log_filter.all_nodes(), minimum=Severity.DEBUG))


def _may_ask_node(screen: LogsScreen) -> bool | None:
    if screen.feed.replay is not None:
        return False
    return True if screen.chosen_node else None


@action(
    "logs.level",
    "K",
    N_("Log level"),
    N_("Read from which severity on the selected node logs, and change it."),
    when=_may_ask_node,
)
def change_level_in_log(screen: LogsScreen) -> None:
    from tui.log_level import change_log_level, full_name

    if screen.chosen_node:
        screen.run_worker(change_log_level(screen.app, full_name(screen.feed.update, screen.chosen_node)))


folding("logs")
taking("logs")


@action(
    "logs.copy_all", "ctrl+y", N_("Copy all"), N_("Copy all lines that are shown to the clipboard of your terminal.")
)
def copy_whole_log(screen: LogsScreen) -> None:
    screen.pane.copy_all()


LOGS_ACTIONS = actions_of(__name__)

"""The actions of the Logs screen; each letter also works as the Cyrillic one on its key."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Protocol

from text.i18n import N_
from tui.actions.action import Action
from tui.log_view.actions import (
    CopyLines,
    FoldLines,
    NextLine,
    PauseLines,
    PreviousLine,
    SaveLines,
    SearchLines,
    ShowsLines,
)

if TYPE_CHECKING:
    from tui.log_view.filter import LogFilter
    from tui.session.feed import Feed


class LogsTarget(ShowsLines, Protocol):
    """The part of the Logs screen that its actions use."""

    @property
    def feed(self) -> Feed:
        """The session."""

    @property
    def chosen_node(self) -> str | None:
        """The node that actions apply to."""

    def choose(self, chosen: LogFilter) -> None:
        """Apply a filter."""

    def hear_all(self) -> None:
        """Show every node, at every severity."""

    def toggle_nodes(self) -> None:
        """Go to the list of nodes, or back to the lines."""

    def change_level(self) -> None:
        """Ask the chosen node for its log level, and change it."""


class LogsAction(Action[LogsTarget]):
    """An action on the log."""

    from_elsewhere = True


class PauseLog(PauseLines[LogsTarget]):
    """Pause, or follow."""

    id = "logs.follow"
    tooltip = N_("Pause while lines come in, or follow the newest again.")


class SearchLog(SearchLines[LogsTarget]):
    """Search the lines."""

    id = "logs.search"
    means = "find"
    tooltip = N_("Find text in the lines as you type; Escape ends it.")
    footer = True


class NextInLog(NextLine[LogsTarget]):
    """Go to the next match."""

    id = "logs.next"
    means = "next"
    tooltip = N_("Go to the next line found.")


class PreviousInLog(PreviousLine[LogsTarget]):
    """Go to the previous match."""

    id = "logs.previous"
    means = "previous"
    tooltip = N_("Go to the previous line found.")


class OnlyFound(LogsAction):
    """Show only matching lines, or all."""

    id = "logs.only_found"
    key = "f,а"
    title = N_("Only found")
    means = "only"
    tooltip = N_("Show only the lines that contain the search text.")

    @classmethod
    def possible(cls, target: LogsTarget) -> bool | None:
        """Only with a search text."""
        return True if target.pane.view.log_filter.search else None

    @classmethod
    async def run(cls, target: LogsTarget) -> None:
        chosen = target.pane.view.log_filter
        target.choose(replace(chosen, only_found=not chosen.only_found))


class RaiseSeverity(LogsAction):
    """Raise the lowest severity shown."""

    id = "logs.severity"
    key = "F,А"
    title = N_("Severity")
    means = "how much of the log"
    tooltip = N_("Hide the least severe lines that are shown; after FATAL all are shown again.")
    footer = True

    @classmethod
    async def run(cls, target: LogsTarget) -> None:
        target.choose(target.pane.view.log_filter.next_minimum())


class ShowNodes(LogsAction):
    """Go to the list of nodes."""

    id = "logs.nodes"
    key = "I,Ш"
    title = N_("Nodes")
    means = "nodes behind it"
    tooltip = N_("Go to the list of nodes, where Enter mutes or unmutes one.")
    footer = True

    @classmethod
    async def run(cls, target: LogsTarget) -> None:
        """Open it, or close it where it covers the log."""
        target.toggle_nodes()


class MuteInLog(LogsAction):
    """Mute a node, or unmute it."""

    id = "logs.mute"
    key = "m,ь"
    title = N_("Mute")
    means = "leave out"
    tooltip = N_("Hide the lines of the selected node, or show them again.")
    footer = True
    from_elsewhere = False

    @classmethod
    def possible(cls, target: LogsTarget) -> bool | None:
        """Only with a node to mute."""
        return True if target.chosen_node else None

    @classmethod
    async def run(cls, target: LogsTarget) -> None:
        if target.chosen_node:
            target.choose(target.pane.view.log_filter.toggled(target.chosen_node))


class HearOneInLog(LogsAction):
    """Mute all nodes but one."""

    id = "logs.alone"
    key = "o,щ"
    title = N_("Only this")
    means = "only this"
    tooltip = N_("Show only the lines of the selected node; press again to undo.")
    footer = True
    from_elsewhere = False

    @classmethod
    def possible(cls, target: LogsTarget) -> bool | None:
        """Only with a node to show."""
        return True if target.chosen_node else None

    @classmethod
    async def run(cls, target: LogsTarget) -> None:
        """Show only that one."""
        if target.chosen_node:
            target.choose(target.pane.view.log_filter.alone(target.chosen_node))


class HearAllInLog(LogsAction):
    """Unmute every node."""

    id = "logs.all"
    key = "a,ф"
    title = N_("All nodes")
    means = "all"
    tooltip = N_("Show the lines of all nodes, at every severity.")

    @classmethod
    async def run(cls, target: LogsTarget) -> None:
        """Show all lines of all nodes."""
        target.hear_all()


class ChangeLevelInLog(LogsAction):
    """Change how much a node logs."""

    id = "logs.level"
    key = "K,Л"
    title = N_("Log level")
    tooltip = N_("Read from which severity on the selected node logs, and change it.")
    from_elsewhere = False

    @classmethod
    def possible(cls, target: LogsTarget) -> bool | None:
        """Only with a node that can be asked."""
        if target.feed.replay is not None:
            return False
        return True if target.chosen_node else None

    @classmethod
    async def run(cls, target: LogsTarget) -> None:
        """Ask the node, then the user."""
        target.change_level()


class FoldLog(FoldLines[LogsTarget]):
    """Wrap long lines, or not."""

    id = "logs.fold"


class CopyLog(CopyLines[LogsTarget]):
    """Copy the chosen lines."""

    id = "logs.copy"


class CopyWholeLog(LogsAction):
    """Copy all lines shown."""

    id = "logs.copy_all"
    key = "ctrl+y"
    title = N_("Copy all")
    tooltip = N_("Copy all lines that are shown to the clipboard of your terminal.")
    from_elsewhere = False

    @classmethod
    async def run(cls, target: LogsTarget) -> None:
        target.pane.copy_all()


class SaveLog(SaveLines[LogsTarget]):
    """Write lines to a file."""

    id = "logs.save"
    means = "write to a file"


LOGS_ACTIONS = (
    PauseLog,
    SearchLog,
    NextInLog,
    PreviousInLog,
    OnlyFound,
    RaiseSeverity,
    ShowNodes,
    MuteInLog,
    HearOneInLog,
    HearAllInLog,
    ChangeLevelInLog,
    FoldLog,
    CopyLog,
    CopyWholeLog,
    SaveLog,
)

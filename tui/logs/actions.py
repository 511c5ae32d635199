"""What can be done on the Logs screen; each letter also under its Cyrillic key."""

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


class LogsTarget(ShowsLines, Protocol):
    """What these actions need of the screen of logs."""

    @property
    def chosen_node(self) -> str | None:
        """The node that is meant."""

    def choose(self, chosen: LogFilter) -> None:
        """Show these lines."""

    def hear_all(self) -> None:
        """Let every node be heard, at every severity."""

    def toggle_nodes(self) -> None:
        """Go to the list of nodes, or back to the lines."""


class LogsAction(Action[LogsTarget]):
    """Something about the log."""

    from_elsewhere = True


class PauseLog(PauseLines[LogsTarget]):
    """Stand still, or follow."""

    id = "logs.follow"
    tooltip = N_("Pause while lines come in, or follow the newest again.")


class SearchLog(SearchLines[LogsTarget]):
    """Search."""

    id = "logs.search"
    means = "find"
    tooltip = N_("Find text in the lines as you type; Escape ends it.")
    footer = True


class NextInLog(NextLine[LogsTarget]):
    """The next found line."""

    id = "logs.next"
    means = "next"
    tooltip = N_("Go to the next line found.")


class PreviousInLog(PreviousLine[LogsTarget]):
    """The previous found line."""

    id = "logs.previous"
    means = "previous"
    tooltip = N_("Go to the previous line found.")


class OnlyFound(LogsAction):
    """Found lines only, or all."""

    id = "logs.only_found"
    key = "f,а"
    title = N_("Only found")
    means = "only"
    tooltip = N_("Leave out the lines that do not hold the text searched for.")

    @classmethod
    def possible(cls, target: LogsTarget) -> bool | None:
        """Only with a text to search for."""
        return True if target.pane.view.log_filter.search else None

    @classmethod
    async def run(cls, target: LogsTarget) -> None:
        """Do the other of the two."""
        chosen = target.pane.view.log_filter
        target.choose(replace(chosen, only_found=not chosen.only_found))


class RaiseSeverity(LogsAction):
    """A higher lowest severity."""

    id = "logs.severity"
    key = "u,г"
    title = N_("Severity")
    means = "how much of the log"
    tooltip = N_("Hide the least severe lines that are shown; after FATAL all are shown again.")
    footer = True

    @classmethod
    async def run(cls, target: LogsTarget) -> None:
        """Take the next one."""
        target.choose(target.pane.view.log_filter.next_minimum())


class ShowNodes(LogsAction):
    """The list of nodes."""

    id = "logs.nodes"
    key = "e,у"
    title = N_("Nodes")
    means = "nodes behind it"
    tooltip = N_("Go to the list of nodes; there Enter mutes one, or lets it be heard.")
    footer = True

    @classmethod
    async def run(cls, target: LogsTarget) -> None:
        """Open it, or close it where it covers the log."""
        target.toggle_nodes()


class MuteInLog(LogsAction):
    """Mute a node, or hear it."""

    id = "logs.mute"
    key = "m,ь"
    title = N_("Mute")
    means = "leave out"
    tooltip = N_("Mute the node of the chosen line or row, or let it be heard again.")
    footer = True
    from_elsewhere = False

    @classmethod
    def possible(cls, target: LogsTarget) -> bool | None:
        """Only with a node to mute."""
        return True if target.chosen_node else None

    @classmethod
    async def run(cls, target: LogsTarget) -> None:
        """Do the other of the two."""
        if target.chosen_node:
            target.choose(target.pane.view.log_filter.toggled(target.chosen_node))


class HearOneInLog(LogsAction):
    """Mute all but one node."""

    id = "logs.alone"
    key = "o,щ"
    title = N_("Only this")
    means = "only this"
    tooltip = N_("Mute all but the node of the chosen line or row; again: as before.")
    footer = True
    from_elsewhere = False

    @classmethod
    def possible(cls, target: LogsTarget) -> bool | None:
        """Only with a node to listen to."""
        return True if target.chosen_node else None

    @classmethod
    async def run(cls, target: LogsTarget) -> None:
        """Listen to it alone."""
        if target.chosen_node:
            target.choose(target.pane.view.log_filter.alone(target.chosen_node))


class HearAllInLog(LogsAction):
    """Hear every node."""

    id = "logs.all"
    key = "a,ф"
    title = N_("All nodes")
    means = "all"
    tooltip = N_("Let every node be heard, at every severity.")

    @classmethod
    async def run(cls, target: LogsTarget) -> None:
        """Mute nobody, leave out nothing."""
        target.hear_all()


class FoldLog(FoldLines[LogsTarget]):
    """Fold long lines, or not."""

    id = "logs.fold"


class CopyLog(CopyLines[LogsTarget]):
    """Copy the lines chosen."""

    id = "logs.copy"


class CopyWholeLog(LogsAction):
    """Copy all lines shown."""

    id = "logs.copy_all"
    key = "Y,Н"
    title = N_("Copy all")
    tooltip = N_("Copy all lines that are shown to the clipboard of your terminal.")
    from_elsewhere = False

    @classmethod
    async def run(cls, target: LogsTarget) -> None:
        """Copy."""
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
    FoldLog,
    CopyLog,
    CopyWholeLog,
    SaveLog,
)

"""The actions of the Deck; each letter also works as the Cyrillic letter on the same key."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Protocol

from launcher.status import NodeState
from text.i18n import N_, _
from text.plain import plain
from tui.actions.action import Action
from tui.actions.keys import WRITE_COMMAND

if TYPE_CHECKING:
    from textual.notifications import SeverityLevel
    from textual.worker import Worker

    from tui.log_view.filter import LogFilter
    from tui.session.feed import Feed


ENDED = frozenset({NodeState.EXITED, NodeState.FAILED})
RUNS = frozenset({NodeState.STARTING, NodeState.READY, NodeState.RUNNING})


class DeckTarget(Protocol):
    """The part of the Deck that its actions use."""

    @property
    def feed(self) -> Feed:
        """The session."""

    @property
    def chosen_node(self) -> str:
        """The chosen node, empty without a session."""

    @property
    def chosen_state(self) -> NodeState | None:
        """The state of the chosen node."""

    @property
    def chosen_file(self) -> str:
        """The learner's own file that the chosen node runs, empty for other nodes."""

    @property
    def sees_nodes(self) -> bool:
        """Whether the nodes are not hidden behind another part of the screen."""

    @property
    def log_filter(self) -> LogFilter:
        """The filter of the log."""

    @property
    def pages(self) -> int:
        """Number of pages of panels."""

    @property
    def driven(self) -> bool:
        """Whether a node takes commands in words."""

    def ask(self, what: str, *names: str) -> Worker[None]:
        """Request this of these nodes, or of all if none is named."""

    def exchange(self) -> Worker[None]:
        """Run the user's own file in place of the chosen node, or Deck's node again."""

    def edit(self) -> None:
        """Open the file of the chosen node in an editor."""

    def filter_log(self, chosen: LogFilter) -> None:
        """Apply a filter to the log."""

    def hear_all(self) -> None:
        """Show the log of every node, at every severity."""

    @property
    def shows_one_panel(self) -> bool:
        """Whether a panel is enlarged."""

    def turn_page(self) -> None:
        """Show the next page of panels, or the next panel in the place of an enlarged one."""

    @property
    def fits_lesson(self) -> bool:
        """Whether there is room for the lesson beside the nodes."""

    async def toggle_lesson(self) -> None:
        """Show the lesson beside the nodes, or not any more."""

    def write_command(self) -> None:
        """Focus the command line."""

    def notify(self, message: str, *, severity: SeverityLevel = "information", markup: bool = True) -> None:
        """Show a notification."""


class DeckAction(Action[DeckTarget]):
    """An action of the Deck."""


class _OfNode(DeckAction):
    """An action on the chosen node."""

    @classmethod
    def possible(cls, target: DeckTarget) -> bool | None:
        """Only with a node chosen and seen, in a session with nodes of its own."""
        if target.feed.watching or not target.feed.nodes or not target.sees_nodes:
            return False
        return True if target.chosen_node else None


class _AskNode(_OfNode):
    """Asks the supervisor to do something with the chosen node."""

    asked: ClassVar[str]
    done: ClassVar[frozenset[NodeState]] = frozenset()
    """States in which the request would change nothing."""

    @classmethod
    def possible(cls, target: DeckTarget) -> bool | None:
        """Not after the session has ended, and not if the node is already in that state."""
        if target.feed.link is None or target.chosen_state in cls.done:
            return False
        return super().possible(target)

    @classmethod
    def shown(cls, target: DeckTarget) -> bool:
        """Not for a node that Deck did not start; there the key explains why."""
        return target.chosen_node not in target.feed.outside.now

    @classmethod
    async def run(cls, target: DeckTarget) -> None:
        """Send the request; nodes that others have started are left alone."""
        name = target.chosen_node
        if name in target.feed.outside.now:
            words = _("{name} was not started by Deck: stop and restart it where it was started")
            target.notify(words.format(name=plain(name, 60)), severity="warning", markup=False)
        else:
            target.ask(cls.asked, name)


class StartNode(_AskNode):
    """Start one node."""

    id = "node.start"
    key = "s,ы"
    title = N_("Start")
    means = "start"
    tooltip = N_("Start the selected node and all nodes that it needs.")
    footer = True
    asked = "start"
    done = RUNS


class StopNode(_AskNode):
    """Stop one node."""

    id = "node.stop"
    key = "x,ч"
    title = N_("Stop")
    means = "stop"
    tooltip = N_("Stop the selected node; press again to force it.")
    footer = True
    asked = "stop"
    done = ENDED


class RestartNode(_AskNode):
    """Restart one node."""

    id = "node.restart"
    key = "r,к"
    title = N_("Restart")
    tooltip = N_("Restart the selected node.")
    footer = True
    asked = "restart"


class EditNode(_OfNode):
    """Edit the file of a node."""

    id = "node.edit"
    key = "e,у"
    title = N_("Edit")
    means = "edit"
    tooltip = N_("Open your file in $EDITOR, at the line of the mistake if there is one.")
    footer = True

    @classmethod
    def possible(cls, target: DeckTarget) -> bool | None:
        """Only for a file of the learner's own."""
        return bool(target.chosen_file) and super().possible(target)

    @classmethod
    async def run(cls, target: DeckTarget) -> None:
        target.edit()


class ExchangeNode(_OfNode):
    """Exchange one node for the learner's own, and back."""

    id = "node.exchange"
    key = "u,г"
    title = N_("My own")
    means = "own or Deck's"
    tooltip = N_("Run a file of your own in the place of the selected node, or Deck's node again.")
    footer = True

    @classmethod
    def possible(cls, target: DeckTarget) -> bool | None:
        """Only for a node of a profile that runs."""
        if target.feed.link is None or target.chosen_node not in target.feed.nodes:
            return False
        return super().possible(target)

    @classmethod
    def label(cls, target: DeckTarget) -> str:
        """Named after what would run."""
        return N_("Deck's own") if target.chosen_file else cls.title

    @classmethod
    async def run(cls, target: DeckTarget) -> None:
        target.exchange()


class _AskAll(DeckAction):
    """Asks the supervisor to do something with all nodes."""

    asked: ClassVar[str]

    @classmethod
    def possible(cls, target: DeckTarget) -> bool | None:
        """Only if there are nodes that Deck has started."""
        return target.feed.link is not None and bool(target.feed.nodes)

    @classmethod
    async def run(cls, target: DeckTarget) -> None:
        target.ask(cls.asked)


class StartAll(_AskAll):
    """Start all nodes."""

    id = "nodes.start"
    key = "S,Ы"
    title = N_("Start all")
    tooltip = N_("Start every node that does not run.")
    asked = "start"


class StopAll(_AskAll):
    """Stop all nodes."""

    id = "nodes.stop"
    key = "X,Ч"
    title = N_("Stop all")
    tooltip = N_("Stop every node, dependants first; press again to force it.")
    asked = "stop"


class RestartAll(_AskAll):
    """Restart all nodes."""

    id = "nodes.restart"
    key = "R,К"
    title = N_("Restart all")
    tooltip = N_("Stop every node and start it again.")
    asked = "restart"


class MuteChosenNode(_OfNode):
    """Hide the log lines of one node."""

    id = "log.mute"
    key = "m,ь"
    title = N_("Mute")
    means = "leave out"
    tooltip = N_("Hide the selected node in the log, or show it again.")
    footer = True

    @classmethod
    async def run(cls, target: DeckTarget) -> None:
        target.filter_log(target.log_filter.toggled(target.chosen_node))


class HearOnly(_OfNode):
    """Hide the log lines of all other nodes."""

    id = "log.only"
    key = "o,щ"
    title = N_("Only this")
    means = "only this"
    tooltip = N_("Show only the selected node's log; press again to undo.")
    footer = True

    @classmethod
    async def run(cls, target: DeckTarget) -> None:
        """Show only this node, or the others again."""
        target.filter_log(target.log_filter.alone(target.chosen_node))


class RaiseLogSeverity(DeckAction):
    """Hide the least severe lines."""

    id = "log.severity"
    key = "F,А"
    title = N_("Severity")
    means = "how much of the log"
    tooltip = N_("Hide the least severe lines that are shown; after FATAL all are shown again.")
    from_elsewhere = True

    @classmethod
    async def run(cls, target: DeckTarget) -> None:
        target.filter_log(target.log_filter.next_minimum())


class HearAllNodes(DeckAction):
    """Show all lines."""

    id = "log.all"
    key = "a,ф"
    title = N_("Whole log")
    means = "all"
    tooltip = N_("Show the lines of all nodes, at every severity.")
    from_elsewhere = True

    @classmethod
    async def run(cls, target: DeckTarget) -> None:
        target.hear_all()


class TurnPage(DeckAction):
    """Show the next page of panels."""

    id = "deck.page"
    key = "v,м"
    title = N_("More panels")
    means = "another view"
    tooltip = N_("Show the panels that have no room on this page; enlarged, the next panel.")
    footer = True
    from_elsewhere = True

    @classmethod
    def possible(cls, target: DeckTarget) -> bool | None:
        """Only if there is more than one page, or a panel is enlarged."""
        return target.pages > 1 or target.shows_one_panel

    @classmethod
    def label(cls, target: DeckTarget) -> str:
        """Named after what it would show."""
        return N_("Next panel") if target.shows_one_panel else cls.title

    @classmethod
    async def run(cls, target: DeckTarget) -> None:
        target.turn_page()


class LessonBeside(DeckAction):
    """Show the lesson beside the nodes, or not any more."""

    id = "deck.lesson"
    key = "shift+f2"
    title = N_("Lesson beside")
    tooltip = N_("Show the step, its task and its checks beside the nodes, from 120x34 on.")

    @classmethod
    def possible(cls, target: DeckTarget) -> bool | None:
        """Only where there is room, and nodes that could be judged."""
        if target.feed.watching or target.feed.replay is not None or not target.feed.nodes:
            return False
        return True if target.fits_lesson else None

    @classmethod
    async def run(cls, target: DeckTarget) -> None:
        await target.toggle_lesson()


class WriteCommand(DeckAction):
    """Type a command to the robot."""

    id = WRITE_COMMAND.id
    key = WRITE_COMMAND.key
    title = N_("Command")
    tooltip = N_("Write a word to /ai_command: forward, left, right, back, stop. Escape leaves.")
    footer = True
    priority = True
    from_elsewhere = True

    @classmethod
    def possible(cls, target: DeckTarget) -> bool | None:
        """Only where a node takes such commands."""
        return target.driven

    @classmethod
    async def run(cls, target: DeckTarget) -> None:
        target.write_command()


DECK_ACTIONS = (
    StartNode,
    StopNode,
    RestartNode,
    EditNode,
    ExchangeNode,
    MuteChosenNode,
    HearOnly,
    WriteCommand,
    TurnPage,
    LessonBeside,
    RaiseLogSeverity,
    HearAllNodes,
    StartAll,
    StopAll,
    RestartAll,
)

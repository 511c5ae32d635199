"""The actions of the Deck."""

from __future__ import annotations

from typing import TYPE_CHECKING

from launcher.status import NodeState
from text.i18n import N_, _
from text.plain import plain
from tui.actions.action import Announce, actions_of
from tui.actions.keys import WRITE_COMMAND
from tui.screens import is_there

if TYPE_CHECKING:
    from tui.deck.screen import LessonDeck

action: Announce[LessonDeck] = Announce()

ENDED = frozenset({NodeState.EXITED, NodeState.FAILED})
RUNS = frozenset({NodeState.STARTING, NodeState.READY, NodeState.RUNNING})


def _of_node(screen: LessonDeck) -> bool | None:
    """Only with a node chosen and seen, in a session with nodes of its own."""
    if screen.feed.watching or not screen.feed.nodes or not screen.sees_nodes:
        return False
    return True if screen.chosen_node else None


def _of_session_node(screen: LessonDeck) -> bool | None:
    return screen.feed.link is not None and _of_node(screen)


def _of_own_node(screen: LessonDeck) -> bool | None:
    return screen.feed.link is not None and screen.chosen_node in screen.feed.nodes and _of_node(screen)


def _is_of_deck(screen: LessonDeck) -> bool:
    """Not a node that Deck did not start; there the key explains why."""
    return screen.chosen_node not in screen.feed.outside.now


def _ask(screen: LessonDeck, what: str) -> None:
    """Ask the supervisor; nodes that others have started are left alone."""
    name = screen.chosen_node
    if _is_of_deck(screen):
        screen.ask(what, name)
    else:
        words = _("{name} was not started by Deck: stop and restart it where it was started")
        screen.notify(words.format(name=plain(name, 60)), severity="warning", markup=False)


@action(
    "node.start",
    "s",
    N_("Start"),
    N_("Start the selected node and all nodes that it needs."),
    means="start",
    footer=True,
    when=lambda screen: screen.chosen_state not in RUNS and _of_session_node(screen),
    shown=_is_of_deck,
)
def start_node(screen: LessonDeck) -> None:
    _ask(screen, "start")


@action(
    "node.stop",
    "x",
    N_("Stop"),
    N_("Stop the selected node; press again to force it."),
    means="stop",
    footer=True,
    when=lambda screen: screen.chosen_state not in ENDED and _of_session_node(screen),
    shown=_is_of_deck,
)
def stop_node(screen: LessonDeck) -> None:
    _ask(screen, "stop")


@action(
    "node.restart",
    "r",
    N_("Restart"),
    N_("Restart the selected node."),
    footer=True,
    when=_of_session_node,
    shown=_is_of_deck,
)
def restart_node(screen: LessonDeck) -> None:
    _ask(screen, "restart")


@action(
    "node.edit",
    "e",
    N_("Edit"),
    N_("Open your file in $EDITOR, at the line of the mistake if there is one."),
    means="edit",
    footer=True,
    when=lambda screen: bool(screen.chosen_file) and _of_node(screen),
)
def edit_node(screen: LessonDeck) -> None:
    screen.edit()


@action(
    "node.exchange",
    "u",
    N_("My own"),
    N_("Run a file of your own in the place of the selected node, or Deck's node again."),
    means="own or Deck's",
    footer=True,
    when=lambda screen: is_there("course") and _of_own_node(screen),
    label=lambda screen: N_("Deck's own") if screen.chosen_file else N_("My own"),
)
def exchange_node(screen: LessonDeck) -> None:
    screen.exchange()


@action(
    "log.mute",
    "m",
    N_("Mute"),
    N_("Hide the selected node in the log, or show it again."),
    means="leave out",
    footer=True,
    when=_of_node,
)
def mute_chosen_node(screen: LessonDeck) -> None:
    screen.filter_log(screen.log_filter.toggled(screen.chosen_node))


@action(
    "log.only",
    "o",
    N_("Only this"),
    N_("Show only the selected node's log; press again to undo."),
    means="only this",
    footer=True,
    when=_of_node,
)
def hear_only(screen: LessonDeck) -> None:
    screen.filter_log(screen.log_filter.alone(screen.chosen_node))


@action(
    WRITE_COMMAND.id,
    WRITE_COMMAND.key,
    N_("Command"),
    N_("Write a word to /ai_command: forward, left, right, back, stop. Escape leaves."),
    footer=True,
    priority=True,
    anywhere=True,
    when=lambda screen: screen.driven,
)
def write_command(screen: LessonDeck) -> None:
    screen.write_command()


@action(
    "deck.page",
    "v",
    N_("More panels"),
    N_("Show the panels that have no room on this page; enlarged, the next panel."),
    means="another view",
    footer=True,
    anywhere=True,
    when=lambda screen: screen.pages > 1 or screen.shows_one_panel,
    label=lambda screen: N_("Next panel") if screen.shows_one_panel else N_("More panels"),
)
def turn_page(screen: LessonDeck) -> None:
    screen.turn_page()


def _has_room_for_lesson(screen: LessonDeck) -> bool | None:
    """Only where there is room, and nodes that could be judged."""
    if screen.feed.watching or screen.feed.replay is not None or not screen.feed.nodes:
        return False
    return True if screen.fits_lesson else None


@action(
    "deck.lesson",
    "shift+f2",
    N_("Lesson beside"),
    N_("Show the step, its task and its checks beside the nodes, from 120x34 on."),
    when=_has_room_for_lesson,
)
async def lesson_beside(screen: LessonDeck) -> None:
    await screen.toggle_lesson()


@action(
    "log.severity",
    "F",
    N_("Severity"),
    N_("Hide the least severe lines that are shown; after FATAL all are shown again."),
    means="how much of the log",
    anywhere=True,
)
def raise_log_severity(screen: LessonDeck) -> None:
    screen.filter_log(screen.log_filter.next_minimum())


@action(
    "log.all", "a", N_("Whole log"), N_("Show the lines of all nodes, at every severity."), means="all", anywhere=True
)
def hear_all_nodes(screen: LessonDeck) -> None:
    screen.hear_all()


def _has_own_nodes(screen: LessonDeck) -> bool | None:
    """Only if there are nodes that Deck has started."""
    return screen.feed.link is not None and bool(screen.feed.nodes)


@action("nodes.start", "S", N_("Start all"), N_("Start every node that does not run."), when=_has_own_nodes)
def start_all(screen: LessonDeck) -> None:
    screen.ask("start")


@action(
    "nodes.stop",
    "X",
    N_("Stop all"),
    N_("Stop every node, dependants first; press again to force it."),
    when=_has_own_nodes,
)
def stop_all(screen: LessonDeck) -> None:
    screen.ask("stop")


@action("nodes.restart", "R", N_("Restart all"), N_("Stop every node and start it again."), when=_has_own_nodes)
def restart_all(screen: LessonDeck) -> None:
    screen.ask("restart")


DECK_ACTIONS = actions_of(__name__)

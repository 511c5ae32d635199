"""What the tour says, page by page; each fits 80x24 in both languages."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from text.i18n import N_
from tui.deck.actions import edit_node, exchange_node, restart_node
from tui.frame.actions.app import (
    SHOW,
    close_session,
    emergency_release,
    emergency_stop,
    leave,
    show_help,
    show_palette,
    switch_language,
)
from tui.lesson.actions import go_on, make_own_folder, take_hint

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tui.actions import Action


class TourPage(NamedTuple):
    """A title, a few sentences, and keys with what they do."""

    title: str
    sentences: Sequence[str]
    keys: Sequence[tuple[Action[Any], str]] = ()


PAGES = (
    TourPage(
        N_("Welcome to Deck"),
        (
            N_(
                "A robot's program is made of many small ones, called nodes. One measures a "
                "distance, another decides, a third turns the wheels. ROS 2 connects them: nodes "
                "talk by topics, services and actions."
            ),
            N_(
                "Deck starts the nodes of a lesson and shows what they say. The robot is "
                "simulated: nothing here can break. Lesson by lesson you replace Deck's nodes by "
                "your own, until the robot drives by your files."
            ),
            N_("The next four pages say how. Escape leaves the tour at once."),
        ),
    ),
    TourPage(
        N_("The list of lessons"),
        (
            N_(
                "It shows how many steps of each lesson you have done, and your points. It opens "
                "on the lesson where you left off."
            ),
        ),
        (
            (go_on, N_("start the lesson and watch, or go on with your own files")),
            (make_own_folder, N_("make your own folder for it, in ~/deck-course, and start it")),
            (close_session, N_("come back to the list")),
        ),
    ),
    TourPage(
        N_("Write, save, see"),
        (
            N_(
                "The Lesson screen has the task of the step, and checks that look at your running "
                "node. Save your file in any editor: Deck starts the node again, and shows for each "
                "check what it expected and what it saw."
            ),
            N_("A step that has passed stays green. Nothing goes on before you do."),
        ),
        (
            (SHOW["lesson"], N_("the Lesson screen")),
            (edit_node, N_("open your file in your editor, at the line of the mistake")),
            (take_hint, N_("a hint, then a plainer one, then the solution")),
            (go_on, N_("go on to the next step")),
        ),
    ),
    TourPage(
        N_("Look inside"),
        (
            N_(
                "The other screens show what the nodes do: their states and logs, every topic with "
                "its messages, who talks to whom, and what followed from what."
            ),
        ),
        (
            (SHOW["deck"], N_("the nodes, the sensors and the wheels")),
            (SHOW["topics"], N_("every topic, the selected one live; the other numbers show more")),
            (restart_node, N_("start the selected node again")),
            (exchange_node, N_("put your own node in the place of Deck's, and back")),
            (show_help, N_("all keys of the screen in front")),
            (show_palette, N_("find anything by its name")),
        ),
    ),
    TourPage(
        N_("Stop and leave"),
        (N_("When the robot does what it should not, there is one key to know:"),),
        (
            (emergency_stop, N_("emergency stop: the wheels stand still at once")),
            (emergency_release, N_("release it")),
            (leave, N_("leave Deck; no node is left running")),
            (switch_language, N_("English / Русский")),
        ),
    ),
)

"""The actions of the Lesson screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Announce, actions_of

if TYPE_CHECKING:
    from tui.lesson.screen import LessonScreen

action: Announce[LessonScreen] = Announce()


@action(
    "lesson.next_step",
    "enter",
    N_("Next step"),
    N_("Go on to the next step, once this one has passed; after the last, to a lesson."),
    footer=True,
    when=lambda screen: (
        screen.at_work.passed_now and (bool(screen.at_work.neighbour(1)) or screen.at_work.next_lesson is not None)
    ),
    label=lambda screen: N_("Next step") if screen.at_work.neighbour(1) else N_("Next lesson"),
)
def go_on(screen: LessonScreen) -> None:
    screen.go_on()


@action(
    "lesson.hint",
    "T",
    N_("Hint"),
    N_("A hint for this step, then a plainer one, then the solution; each is noted."),
    footer=True,
    when=lambda screen: screen.at_work.more_help,
)
def take_hint(screen: LessonScreen) -> None:
    screen.take_hint()


@action(
    "lesson.edit",
    "e",
    N_("Edit"),
    N_("Open your file in $EDITOR, at the line of the mistake if there is one."),
    means="edit",
    footer=True,
    when=lambda screen: screen.at_work.node is not None,
)
def edit_file(screen: LessonScreen) -> None:
    screen.edit()


@action(
    "lesson.compare",
    "v",
    N_("Solution"),
    N_("Show how your file differs from the solution, or the text again."),
    means="another view",
    footer=True,
    when=lambda screen: screen.can_compare,
    label=lambda screen: N_("Text") if screen.beside else N_("Solution"),
)
def compare_files(screen: LessonScreen) -> None:
    screen.compare()


@action(
    "lesson.own",
    "C",
    N_("My own files"),
    N_("Make a folder of your own for this lesson, if there is none, and open it."),
    means="own files",
    footer=True,
    when=lambda screen: screen.at_work.folder is not None and not screen.at_work.own,
)
def make_own_folder(screen: LessonScreen) -> None:
    screen.make_own()


@action(
    "lesson.step",
    "n",
    N_("Step"),
    N_("Look at the next step, whether this one has passed or not."),
    means="next",
    when=lambda screen: bool(screen.at_work.neighbour(1)),
)
def next_step(screen: LessonScreen) -> None:
    screen.go(1)


@action(
    "lesson.step_back",
    "N",
    N_("Previous step"),
    N_("Look at the step before."),
    means="previous",
    when=lambda screen: bool(screen.at_work.neighbour(-1)),
)
def previous_step(screen: LessonScreen) -> None:
    screen.go(-1)


LESSON_ACTIONS = actions_of(__name__)

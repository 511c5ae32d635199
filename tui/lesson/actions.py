"""The actions of the Lesson screen; each letter also works as the Cyrillic one on its key."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from text.i18n import N_
from tui.actions.action import Action

if TYPE_CHECKING:
    from tui.lesson.at_work import LessonAtWork


class LessonTarget(Protocol):
    """The part of the Lesson screen that its actions use."""

    @property
    def at_work(self) -> LessonAtWork:
        """The lesson."""

    @property
    def beside(self) -> bool:
        """Whether the solution is shown beside the learner's file."""

    @property
    def can_compare(self) -> bool:
        """Whether the solution may be shown."""

    def go(self, by: int) -> None:
        """Go to that step."""

    def go_on(self) -> None:
        """Go to the next step, and after the last one to the next lesson."""

    def take_hint(self) -> object:
        """Show the next hint; after the last one the solution, if it is wanted."""

    def compare(self) -> None:
        """Show the solution beside the learner's file, or the text again."""

    def edit(self) -> None:
        """Open the learner's file in an editor."""

    def make_own(self) -> None:
        """Make the learner's folder, and open it."""


class LessonAction(Action[LessonTarget]):
    """An action of the Lesson screen."""

    @classmethod
    def possible(cls, target: LessonTarget) -> bool | None:
        """Only with a lesson."""
        return target.at_work.folder is not None


class GoOn(LessonAction):
    """Go on after a step has passed."""

    id = "lesson.next_step"
    key = "enter"
    title = N_("Next step")
    tooltip = N_("Go on to the next step, once this one has passed; after the last, to a lesson.")
    footer = True

    @classmethod
    def label(cls, target: LessonTarget) -> str:
        """Named after what comes next."""
        return cls.title if target.at_work.neighbour(1) else N_("Next lesson")

    @classmethod
    def possible(cls, target: LessonTarget) -> bool | None:
        """Only after it has passed, and if there is another step, or a lesson after all of them."""
        return target.at_work.passed_now and (
            bool(target.at_work.neighbour(1)) or target.at_work.next_lesson is not None
        )

    @classmethod
    async def run(cls, target: LessonTarget) -> None:
        target.go_on()


class TakeHint(LessonAction):
    """Ask for a hint."""

    id = "lesson.hint"
    key = "T,Е"
    title = N_("Hint")
    tooltip = N_("A hint for this step, then a plainer one, then the solution; each is noted.")
    footer = True

    @classmethod
    def possible(cls, target: LessonTarget) -> bool | None:
        """Only if there is more help."""
        return target.at_work.more_help

    @classmethod
    async def run(cls, target: LessonTarget) -> None:
        target.take_hint()


class CompareFiles(LessonAction):
    """The solution and the learner's file."""

    id = "lesson.compare"
    key = "v,м"
    title = N_("Solution")
    means = "another view"
    tooltip = N_("Show how your file differs from the solution, or the text again.")
    footer = True

    @classmethod
    def label(cls, target: LessonTarget) -> str:
        """Named after what it would show now."""
        return N_("Text") if target.beside else cls.title

    @classmethod
    def possible(cls, target: LessonTarget) -> bool | None:
        """Only after the solution was asked for, or the step has passed."""
        return target.can_compare

    @classmethod
    async def run(cls, target: LessonTarget) -> None:
        target.compare()


class EditFile(LessonAction):
    """Edit the file of this step."""

    id = "lesson.edit"
    key = "e,у"
    title = N_("Edit")
    means = "edit"
    tooltip = N_("Open your file in $EDITOR, at the line of the mistake if there is one.")
    footer = True

    @classmethod
    def possible(cls, target: LessonTarget) -> bool | None:
        """Only with a file of the learner's."""
        return target.at_work.node is not None

    @classmethod
    async def run(cls, target: LessonTarget) -> None:
        target.edit()


class MakeOwnFolder(LessonAction):
    """Make the learner's folder."""

    id = "lesson.own"
    key = "C,С"
    title = N_("My own files")
    means = "own files"
    tooltip = N_("Make a folder of your own for this lesson, if there is none, and open it.")
    footer = True

    @classmethod
    def possible(cls, target: LessonTarget) -> bool | None:
        """Only while Deck's own nodes run."""
        return target.at_work.folder is not None and not target.at_work.own

    @classmethod
    async def run(cls, target: LessonTarget) -> None:
        target.make_own()


class NextStep(LessonAction):
    """Look at the next step."""

    id = "lesson.step"
    key = "n,т"
    title = N_("Step")
    means = "next"
    tooltip = N_("Look at the next step, whether this one has passed or not.")

    @classmethod
    def possible(cls, target: LessonTarget) -> bool | None:
        """Only if there is one."""
        return bool(target.at_work.neighbour(1))

    @classmethod
    async def run(cls, target: LessonTarget) -> None:
        target.go(1)


class PreviousStep(LessonAction):
    """Look at the previous step."""

    id = "lesson.step_back"
    key = "N,Т"
    title = N_("Previous step")
    means = "previous"
    tooltip = N_("Look at the step before.")

    @classmethod
    def possible(cls, target: LessonTarget) -> bool | None:
        """Only if there is one."""
        return bool(target.at_work.neighbour(-1))

    @classmethod
    async def run(cls, target: LessonTarget) -> None:
        target.go(-1)


LESSON_ACTIONS = (GoOn, TakeHint, EditFile, CompareFiles, MakeOwnFolder, NextStep, PreviousStep)

"""The checks of the step at hand, and what there is to do about them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.content import Content

from course.results import State
from text.i18n import _
from tui.frame.actions.app import CloseSession, ShowLesson
from tui.lesson import words
from tui.lesson.actions import MakeOwnFolder

if TYPE_CHECKING:
    from collections.abc import Iterable

    from tui.frame.host import Host
    from tui.lesson.at_work import LessonAtWork


def judged_lines(at_work: LessonAtWork, host: Host, *, beside: bool = False) -> Iterable[Content]:
    """Yield the checks, or which steps are waited for, and then what comes next.

    `beside`: it is not the Lesson screen that shows them, so its keys are a key away.
    """
    step, lesson = at_work.step, at_work.folder
    if step is None or lesson is None:
        return
    there = host.keys_of(ShowLesson)[0]
    result = at_work.result(step)
    if result.state is State.WAITS:
        yield from words.waiting_lines(lesson.steps, step, at_work.passed)
    else:
        yield from words.check_lines(result)
    if not at_work.own:
        told = _("Deck's own nodes run. {key} starts files of your own for this lesson.")
        key = host.keys_of(MakeOwnFolder)[0]
        yield Content(told.format(key=f"{there}, {key}" if beside else key))
    elif result.state is State.PASSED:
        more = at_work.neighbour(1)
        faded = [step for step in lesson.steps if at_work.was_right(step.id) is not None]
        if not more and faded:
            told = _("Passed, but other steps have not with these files: {steps}.").format(
                steps=", ".join(str(lesson.steps.index(step) + 1) for step in faded)
            )
        elif not more:
            told = _("Passed. That was the last step.")
        elif beside:
            told = _("Passed. {key}, then Enter, goes on.").format(key=there)
        else:
            told = _("Passed. Enter goes on.")
        yield Content.styled(told, "bold $text-success")
        if not more:
            yield Content(where_lessons_are(host))
    elif not result.checks and result.state is not State.WAITS:
        yield Content.styled(_("being judged…"), "$text-muted")


def where_lessons_are(host: Host) -> str:
    """Say which key opens the list."""
    return _("{key} opens the list of lessons.").format(key=host.keys_of(CloseSession)[0])

"""The checks of the step at hand, and what there is to do about them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.content import Content

from course.results import State
from text.i18n import _
from text.plain import plain
from tui.frame.actions.app import SHOW, close_session
from tui.lesson import words
from tui.lesson.actions import make_own_folder

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
    there = host.keys_of(SHOW["lesson"])[0]
    result = at_work.result(step)
    if result.state is State.WAITS:
        yield from words.waiting_lines(lesson.steps, step, at_work.passed)
    else:
        yield from words.check_lines(result, hinted=at_work.hinted)
    if not at_work.own:
        told = _("Deck's own nodes run. {key} starts files of your own for this lesson.")
        key = host.keys_of(make_own_folder)[0]
        yield Content(told.format(key=f"{there}, {key}" if beside else key))
    elif result.state is State.PASSED:
        yield Content.styled(_after(at_work, there if beside else ""), "bold $text-success")
        yield from grade_lines(at_work)
        if not at_work.neighbour(1):
            yield from _next_lesson(at_work, host, there if beside else "")
    elif at_work.grade is not None and at_work.grade.failed:
        yield from grade_lines(at_work)
    elif not result.checks and result.state is not State.WAITS:
        yield Content.styled(_("being judged…"), "$text-muted")


def _after(at_work: LessonAtWork, there: str) -> str:
    """Say what comes after a step that has passed; `there` is the key to the Lesson screen."""
    steps = at_work.folder.steps if at_work.folder is not None else ()
    faded = [str(number) for number, step in enumerate(steps, start=1) if at_work.was_right(step.id) is not None]
    if at_work.grading:
        return _("Passed. All of the lesson is being graded once more…")
    if at_work.neighbour(1) and there:
        return _("Passed. {key}, then Enter, goes on.").format(key=there)
    if at_work.neighbour(1):
        return _("Passed. Enter goes on.")
    if faded:
        told = _("Passed, but other steps have not with these files: {steps}.")
        return told.format(steps=", ".join(faded))
    return _("Passed. That was the last step.")


def _next_lesson(at_work: LessonAtWork, host: Host, there: str) -> Iterable[Content]:
    """Yield which lesson comes next, and where all are; `there`: as in `_after`."""
    if at_work.next_lesson is not None:
        name = plain(at_work.next_lesson.name, words.LONGEST)
        if there:
            told = _("{key}, then Enter, opens the next lesson, {name}.")
            yield Content(told.format(key=there, name=name))
        else:
            yield Content(_("Enter opens the next lesson, {name}.").format(name=name))
    yield Content(where_lessons_are(host))


def grade_lines(at_work: LessonAtWork) -> Iterable[Content]:
    """Yield what `deck grade` says of these files, if it was asked."""
    grade = at_work.grade
    if grade is None:
        return
    told = _("deck grade: {points} of {most} points").format(points=grade.points, most=grade.most)
    right = not grade.failed and not grade.ungraded
    yield Content.styled(told, "bold $text-success" if right else "bold $text-warning")
    lesson = at_work.folder
    for number, step in enumerate(lesson.steps if lesson is not None else (), start=1):
        if step.id in grade.failed:
            yield Content(f"  {number}: {plain(grade.failed[step.id], words.LONGEST)}")
    if grade.ungraded:
        yield Content(f"  {plain(grade.ungraded, words.LONGEST)}")


def where_lessons_are(host: Host) -> str:
    """Say which key opens the list."""
    return _("{key} opens the list of lessons.").format(key=host.keys_of(close_session)[0])

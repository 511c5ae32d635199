"""A step in words: how far it is, what each check expects and has seen, and the learner's file."""

from __future__ import annotations

import difflib
import time
from pathlib import Path
from typing import TYPE_CHECKING

from textual.content import Content

from course.results import State
from text.i18n import N_, _, localized, ngettext, pick
from text.plain import plain
from tui.widgets.node_words import fault_lines, state_words

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from course.results import CheckResult, StepResult
    from launcher.profile.steps.model import StepDocument
    from launcher.status import NodeStatus
    from tui.lesson.at_work import LessonAtWork

STATES = {
    State.NOT_YET: ("·", N_("not yet"), "$text-muted"),
    State.PASSED: ("✓", N_("passed"), "$text-success"),
    State.FAILED: ("✗", N_("not right yet"), "$text-error"),
    State.UNJUDGED: ("?", N_("could not be judged"), "$text-warning"),
    State.WAITS: ("◌", N_("waits"), "$text-muted"),
}
"""Sign, word and colour: colour is never the only indication."""
FADED = "○"
"""The sign of a step that has passed with other files."""
LONGEST = 400


def head(
    step: StepDocument,
    number: int,
    count: int,
    state: State,
    was_right: int | None = None,
    *,
    saw_solution: bool = False,
) -> Content:
    """Return the line above everything: which step, what it is worth, how far it is.

    `was_right`: when it passed with other files, see `LessonAtWork.was_right`.
    """
    sign, word, colour = STATES[state]
    points = ngettext("{n} point", "{n} points", step.points).format(n=step.points)
    title = plain(pick(step.title) or step.id, LONGEST)
    faded = "" if was_right is None else f" · {was_right_words(was_right)}"
    with_it = _("with the solution")
    helped = f" · {with_it}" if saw_solution else ""
    return Content.assemble(
        (f"{number}/{count} {title}", "bold"),
        (f" · {points}{helped}   ", "$text-muted"),
        (f"{sign} {_(word)}", f"bold {colour}"),
        (faded, "$text-muted"),
    )


def was_right_words(at_s: int) -> str:
    """Say when a step passed whose tick has faded."""
    if not at_s:
        return _("was right earlier")
    then, now = time.localtime(at_s), time.localtime()
    today = then[:3] == now[:3]
    return _("was right at {time}").format(time=time.strftime("%H:%M" if today else "%Y-%m-%d %H:%M", then))


def overview(at_work: LessonAtWork, shown: str, points: str) -> Content:
    """Return all steps as signs, the one that is shown in brackets; the points, and the seed."""
    done, seed = at_work.passed, at_work.seed
    parts = []
    for step in at_work.folder.steps if at_work.folder is not None else ():
        faded = at_work.was_right(step.id) is not None
        sign = "✓" if step.id in done else FADED if faded else "·"
        colour = "$text-success" if step.id in done else "$text-muted"
        text = f"[{sign}]" if step.id == shown else f" {sign} "
        parts.append((text, f"bold {colour}" if step.id == shown else colour))
    parts.append((f"  {points}", "$text-muted"))
    if seed:
        drawn = _("seed {seed}").format(seed=seed)
        parts.append((f" · {drawn}", "$text-muted"))
    return Content.assemble(*parts)


def waiting_lines(steps: Sequence[StepDocument], step: StepDocument, passed: Iterable[str]) -> list[Content]:
    """Return which steps this one waits for, as they are numbered above."""
    done = set(passed)
    return [
        Content.styled(
            _("waits for step {number}: {title}").format(
                number=number, title=plain(pick(needed.title) or needed.id, LONGEST)
            ),
            "$text-warning",
        )
        for number, needed in enumerate(steps, start=1)
        if needed.id in step.needs and needed.id not in done
    ]


def check_lines(result: StepResult, *, hinted: bool) -> list[Content]:
    """Return the checks: each with its sign; one that fails also with what was seen, and where.

    `hinted`: a hint was asked for, so that the lesson may say where, too.
    """
    lines = [Content.styled(_told(result.reason), "$text-warning")] if result.reason else []
    for check in result.checks:
        lines += _check(check, hinted=hinted)
    return lines


def _check(check: CheckResult, *, hinted: bool) -> list[Content]:
    sign, _word, colour = STATES[check.state]
    lines = [Content.assemble((f"{sign} ", colour), (_told(check.what), ""))]
    if check.state in (State.FAILED, State.UNJUDGED):
        if check.seen:
            seen = _("seen: {words}").format(words=_told(check.seen))
            lines.append(Content.styled(f"  {seen}", colour))
        look = check.hint if hinted and check.hint else check.look
        if look:
            lines.append(Content.styled(f"  → {_told(look)}", "$text-accent"))
    return lines


def hint_lines(step: StepDocument, taken: int) -> list[Content]:
    """Return the hints that were asked for."""
    lines = []
    for number, hint in enumerate(step.hints[:taken], start=1):
        name = _("Hint {number}").format(number=number)
        lines.append(Content.assemble((f"{name}: ", "bold $text-warning"), plain(pick(hint), LONGEST)))
    return lines


def file_lines(node: NodeStatus | None, command: str) -> list[Content]:
    """Return the learner's file and how its node is, and what is wrong with it."""
    lines = []
    if node is not None:
        sign, word, meaning = state_words(node)
        colour = {"good": "$text-success", "warn": "$text-warning", "bad": "$text-error"}
        lines.append(
            Content.assemble(
                (plain(_from_home(node.file), LONGEST), "bold"),
                (f"  {sign} {_(word)}", colour.get(meaning, "$text-muted")),
            )
        )
        lines += fault_lines(node)
        in_terminal = _("In a terminal: {command}").format(command=command)
        lines.append(Content.styled(in_terminal, "$text-muted"))
    return lines


def _from_home(file: str) -> str:
    home = f"{Path.home()}/"
    return f"~/{file.removeprefix(home)}" if file.startswith(home) else file


def difference(own: str, solution: str) -> Content:
    """Return both files in one, with what only one of them has marked by sign and colour."""
    colours = {"-": "$text-error", "+": "$text-success", " ": "$text-muted"}
    lines = [
        Content.styled(plain(f"{line[0]} {line[2:].rstrip()}", LONGEST), colours[line[0]])
        for line in difflib.ndiff(own.splitlines(), solution.splitlines())
        if line[0] in colours
    ]
    head = Content.assemble(
        (_("- only in your file"), "bold $text-error"), "   ", (_("+ only in the solution"), "bold $text-success")
    )
    return Content("\n").join([head, *lines])


def _told(words: str) -> str:
    return plain(localized(words), LONGEST)

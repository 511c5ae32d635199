"""`deck lesson check` and `deck lesson new`: lessons for those who write them."""

from __future__ import annotations

import sys
from argparse import Namespace
from pathlib import Path

from cli.commands import Parser, command
from cli.options import add_seed, at_once
from course.lessons.catalog import find_lesson, lessons
from course.proof.proof import ProofVerdict, incomplete, prove, variants
from course.proof.skeleton import new_lesson
from course.proof.trial import unused_domains
from launcher.profile.defaults import shown
from text.i18n import _, localized, ngettext
from text.output import GREEN, RED, Paint, write
from text.plain import plain


def _lesson_options(parser: Parser) -> None:
    parser.add_argument("action", choices=("check", "new"))
    parser.add_argument("lessons", nargs="*", metavar=_("LESSON"), help=_("name, number or folder; all by default"))
    parser.add_argument("--jobs", metavar="N", type=at_once, default=2, help=_("how many runs at once, 2 by default"))
    add_seed(parser)
    parser.epilog = _(
        "check: the starter must fail, the solution pass, and each mistake in wrong.diff be caught"
        " at its step. Exit code: 0 if so, else 1."
    )


@command("lesson", _lesson_options)
async def lesson_command(options: Namespace) -> int:
    if options.action == "new":
        folder = new_lesson(Path(options.lessons[0] if options.lessons else "my-lesson"))
        write(_("made {path}; next: deck lesson check {path}").format(path=plain(shown(folder))))
        return 0
    chosen = [find_lesson(name) for name in options.lessons] or list(lessons().values())
    paint = Paint(sys.stdout)
    wrong = 0
    for lesson in chosen:
        for words in incomplete(lesson):
            write(f"{plain(lesson.name)}: {paint(localized(words), RED)}")
            wrong += 1
    everything = [variant for lesson in chosen for variant in variants(lesson)]
    async for verdict in prove(everything, unused_domains(options.jobs), seed=options.seed):
        write(f"{plain(verdict.variant.lesson.name)}: {_line(verdict, paint)}")
        wrong += bool(verdict.complaint)
    if wrong:
        write(_("{n} of it is not as it should be").format(n=wrong))
        return 1
    count = len(everything)
    write(ngettext("proven by {n} run", "proven by {n} runs", count).format(n=count))
    return 0


def _line(verdict: ProofVerdict, paint: Paint) -> str:
    variant = verdict.variant
    name = plain(variant.name)
    if verdict.complaint:
        seed = f" (seed {verdict.seed})" if verdict.seed else ""
        return f"{name}: {paint(localized(verdict.complaint), RED)}{seed}"
    well = _("passes") if variant.fails_at is None else _("fails, as it should")
    return f"{name}: {paint(well, GREEN)}"

"""`deck doctor`: the findings as lines, or as JSON."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Iterable

from cli.commands import Parser, command
from cli.doctor.checks import examine
from cli.doctor.finding import Finding, Level
from cli.options import add_graph, add_json
from launcher.errors import UsageError
from text.i18n import N_, _
from text.output import DIM, GREEN, RED, YELLOW, Paint, json_text, write
from text.plain import plain
from text.sentences import say

LOOKS = {Level.OK: (N_("ok"), GREEN), Level.WARN: (N_("warn"), YELLOW), Level.FAIL: (N_("FAIL"), RED)}


def _doctor_options(parser: Parser) -> None:
    parser.add_argument("what", nargs="?", choices=("llm",), help=_("llm: ask the language model for a test"))
    parser.add_argument(
        "--graph", action="store_true", help=_("examine the running ROS graph instead, whoever has started its nodes")
    )
    add_graph(parser, _("with --graph: ROS domain; by default that of the running robot"))
    add_json(parser)
    parser.epilog = _(
        "Exit code: 0, or 1 if something essential is missing. With --graph: 0 without findings, 1 "
        "with some, 2 if there is no graph to look at."
    )


@command("doctor", _doctor_options)
def doctor_command(options: Namespace) -> int:
    """Examine everything, or try the language model; return 1 if something essential is missing.

    Of the graph, any finding makes it 1.
    """
    if options.graph:
        return _graph(options)
    if options.domain is not None:
        raise UsageError(say("--domain goes with --graph"))
    if options.discovery is not None:
        raise UsageError(say("--discovery goes with --graph"))
    findings = _tried() if options.what == "llm" else examine()
    if options.json:
        write(json_text([finding.for_programs() for finding in findings], indent=2))
    else:
        show(findings, Paint(sys.stdout))
    return 1 if any(finding.level is Level.FAIL for finding in findings) else 0


def _graph(options: Namespace) -> int:
    """Examine the running graph. Raises UsageError if there is none."""
    from cli.doctor.graph import examine_graph

    if options.what:
        raise UsageError(say("--graph does not go with {what}", what=options.what))
    seen = examine_graph(options.domain, options.discovery)
    if options.json:
        write(json_text(seen.for_programs(), indent=2))
    else:
        show(seen.lines(), Paint(sys.stdout))
        write(seen.summary())
    return 1 if seen.found else 0


def _tried() -> list[Finding]:
    """Ask the language model. Raises UsageError if there are no settings that can be used."""
    from brain.faults import ModelError
    from cli.doctor.llm import try_model

    try:
        return try_model()
    except ModelError as error:
        raise UsageError(*filter(None, (error.words, error.fix))) from None


def show(findings: Iterable[Finding], paint: Paint) -> None:
    """Write a line for each finding, with the fix below it."""
    width = max(len(_(word)) for word, _colour in LOOKS.values())
    for finding in findings:
        word, colour = LOOKS[finding.level]
        write(f"{paint(_(word).ljust(width), colour)}  {plain(finding.text)}")
        if finding.fix:
            write(f"{'':{width}}  {paint('-> ' + finding.fix, DIM)}")

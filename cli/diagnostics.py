"""`deck diagnostics`: what everybody says on /diagnostics, once, as a tree, the worst first."""

from __future__ import annotations

import sys
import time
from argparse import Namespace

from cli.commands import Parser, command
from cli.observing import FOUND_S, DomainView, domain_view, tell_that_it_takes_time
from cli.options import add_graph, add_json, seconds
from graph.data import GraphUpdate
from graph.diagnostics import DiagnosticsBook, StatusLevel, StatusRecord, TreeRow, tree
from launcher.errors import UsageError
from robot.topics import DIAGNOSTICS
from text.i18n import N_, _
from text.output import DIM, GREEN, RED, YELLOW, Paint, json_text, write
from text.sentences import say

LOOKS = {
    StatusLevel.OK: (N_("ok"), GREEN),
    StatusLevel.WARN: (N_("warn"), YELLOW),
    StatusLevel.ERROR: (N_("ERROR"), RED),
    StatusLevel.STALE: (N_("stale"), DIM),
}


def _diagnostics_options(parser: Parser) -> None:
    parser.add_argument(
        "--for", dest="seconds", metavar="S", type=seconds, default=3.0, help=_("listen for S seconds, 3 by default")
    )
    add_graph(parser, _("ROS domain; by default that of the running robot"))
    add_json(parser)
    parser.epilog = _("Exit code: 0 if everything is all right, 1 if anything is not, 2 if nobody says anything.")


@command("diagnostics", _diagnostics_options)
def diagnostics_command(options: Namespace) -> int:
    """Listen for a moment, and show the tree; return 1 if anything is not all right."""
    with domain_view(options.domain, options.discovery, followed=frozenset({DIAGNOSTICS})) as view:
        words = _("listening to {topic} in domain {domain} for {seconds:g} s")
        tell_that_it_takes_time(words.format(topic=DIAGNOSTICS, domain=view.domain, seconds=options.seconds))
        book = _heard(view, options.seconds)
    rows = tree(book.records)
    if options.json:
        told = [_for_programs(row.path, row.record) for row in rows if row.record is not None]
        write(json_text(told, indent=2))
    else:
        _show(rows, book.left_out)
    return 0 if all(row.level is StatusLevel.OK for row in rows) else 1


def _heard(view: DomainView, seconds: float) -> DiagnosticsBook:
    """Return what was said for so long.

    Raises:
        UsageError: if ROS cannot be used, or nobody says anything.
    """
    book, update = DiagnosticsBook(), GraphUpdate(0.0)
    while (passed_s := view.listened_s()) < max(seconds, FOUND_S):
        for update in view.updates():
            book.take(update.samples.get(DIAGNOSTICS, ()))
        if book.records and passed_s >= seconds:
            break
    book.look(time.time())
    if not book.records:
        view.refuse_empty(update)
        raise UsageError(
            say("nobody has said anything on {topic} in domain {domain}", topic=DIAGNOSTICS, domain=view.domain)
        )
    return book


def _show(rows: tuple[TreeRow, ...], left_out: int) -> None:
    paint = Paint(sys.stdout)
    width = max(len(_(word)) for word, _colour in LOOKS.values())
    names = max(2 * row.depth + len(row.label) for row in rows)
    for row in rows:
        word, colour = LOOKS[row.level]
        name = f"{'  ' * row.depth}{row.label}"
        said = "" if row.record is None else row.record.status.message
        line = f"{paint(_(word).ljust(width), colour)}  {name.ljust(names if said else 0)}"
        write(f"{line}  {said}" if said else line)
    if left_out:
        write(_("and {count} more that were not kept").format(count=left_out))


def _for_programs(path: tuple[str, ...], record: StatusRecord) -> dict[str, object]:
    status = record.status
    return {
        "name": status.name,
        "path": list(path),
        "level": record.level.name,
        "message": status.message,
        "hardware_id": status.hardware,
        "values": dict(status.values),
    }

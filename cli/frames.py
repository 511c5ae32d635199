"""`deck frames`: the tree of the frames on /tf and /tf_static, and what is wrong with it.

With `--json` it writes one object with `domain`, `frames`, a row for each frame in each of its
parents, and `findings`.
"""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from cli.commands import Parser, command
from cli.domains import beyond_this_machine
from cli.observing import DomainView, domain_view
from cli.options import add_graph, add_json, seconds
from text.i18n import _, localized
from text.output import DIM, RED, Paint, json_text, table, write
from tui.frame_tree import cells

if TYPE_CHECKING:
    from graph.data import FrameRow, GraphUpdate
    from graph.findings.finding import GraphFinding
    from graph.frames.tree import FrameTree

STEADY_S = 2.0
"""While nodes or frames have been found within so many seconds, there may be more."""
PATIENCE_S = 6.0
"""Seconds more for what is still to come."""
LOOK_S = 3.0
"""Seconds in which nodes are found, rates measured and silence noticed."""


def _frames_options(parser: Parser) -> None:
    parser.add_argument(
        "--for", dest="seconds", metavar="S", type=seconds, help=_("listen for S seconds; 3 by default")
    )
    add_graph(parser, _("ROS domain; by default that of the running robot"))
    add_json(parser)
    parser.epilog = _(
        "Exit code: 0 if nothing is wrong with the frames, 1 if something is or there are none, 2 "
        "if ROS or the command line cannot be used."
    )


@command("frames", _frames_options)
def frames_command(options: Namespace) -> int:
    from graph.frames.findings import findings_in
    from graph.frames.tree import FrameTree

    with domain_view(options.domain, options.discovery, frames=True, all_topics=True, all_images=False) as view:
        update = _listen(view, options.seconds or LOOK_S)
    tree = FrameTree(update.frames)
    findings = findings_in(update, tree)
    if options.json:
        rows = [_for_programs(row) for row in update.frames]
        found = [_finding_for_programs(one) for one in findings]
        write(json_text({"domain": view.domain, "frames": rows, "findings": found}, indent=2))
    else:
        _show(tree, findings, view.domain)
        if not update.frames and (hint := beyond_this_machine(view.discovery)):
            write(localized(hint))
    return 1 if findings or not update.frames else 0


def _listen(view: DomainView, seconds: float) -> GraphUpdate:
    """Return the last update after so long, and longer for what is still to come."""
    from graph.data import GraphUpdate
    from graph.frames.findings import is_settling

    update, known, changed_s = GraphUpdate(0.0), (0, 0), 0.0
    while True:
        for update in view.updates():
            if known != (known := (len(update.nodes), len(update.frames))):
                changed_s = view.listened_s()
        passed_s = view.listened_s()
        coming = is_settling(update) or passed_s - changed_s < STEADY_S
        if passed_s >= seconds and not (coming and passed_s < seconds + PATIENCE_S):
            return update


def _for_programs(row: FrameRow) -> dict[str, Any]:
    newest = row.newest
    return {
        "frame": newest.child,
        "parent": newest.parent,
        "static": row.is_static,
        "count": row.count,
        "refused": row.faults,
        "hz": row.hz,
        "age_s": row.age_s,
        "delay_s": row.delay_s,
        "publishers": list(row.publishers),
        "certain": row.certain,
        "gone": row.gone,
        "translation": list(newest.transform.translation),
        "rotation": list(newest.transform.rotation),
    }


def _finding_for_programs(one: GraphFinding) -> dict[str, Any]:
    return {"key": one.rule, "frames": list(one.nodes), "text": localized(one.what), "mend": localized(one.mend)}


def _show(tree: FrameTree, findings: Sequence[GraphFinding], domain: int) -> None:
    paint = Paint(sys.stdout)
    lines = tree.lines()
    if not lines:
        write(_("no frames in domain {domain}").format(domain=domain))
    else:
        head = (_("FRAME"), _("RATE"), _("AGE"), _("PUBLISHER"))
        rows = [
            (cells.name(line), cells.state(line)[0], cells.age(line)[0], cells.publisher(line)[0]) for line in lines
        ]
        for row in table(head, rows):
            write(row)
    for one in findings:
        write(f"{paint('✗', RED)} {localized(one.what)}")
        write(f"  {paint('-> ' + localized(one.mend), DIM)}")
    if lines and not findings:
        write(_("✓ nothing is wrong with the frames"))

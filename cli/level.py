"""`deck level`: from which severity on a running node logs; read, or set.

Exit codes: 0 if it was read or set, 1 if the node refuses, does not answer, or is not there.
"""

from __future__ import annotations

from argparse import Namespace

from cli.commands import Parser, command
from cli.domains import beyond_this_machine
from cli.observing import domain_view
from cli.options import add_graph
from graph.inner_states import LOG_LEVELS
from text.i18n import _, localized
from text.output import say_error, write
from text.plain import plain


def _level_options(parser: Parser) -> None:
    parser.add_argument("node", metavar=_("NODE"), help=_("a node by its name in the graph"))
    parser.add_argument(
        "level",
        nargs="?",
        choices=tuple(LOG_LEVELS),
        help=_("from this severity on it is to log; without it, the level is only shown"),
    )
    add_graph(parser, _("ROS domain; by default that of the running robot"))
    parser.epilog = _(
        "Exit code: 0, or 1 if the node is not there, does not answer or does not let others change its level."
    )


@command("level", _level_options)
def level_command(options: Namespace) -> int:
    from graph.observer.requests import LogLevel

    node = f"/{options.node.removeprefix('/')}"
    with domain_view(options.domain, options.discovery) as view:
        found = view.finds(node)
        result = view.observer.ask(LogLevel(node, options.level)).result()
    if result.error:
        say_error(f"deck: {plain(localized(result.error))}")
        if not found and (hint := beyond_this_machine(view.discovery)):
            say_error(f"deck: {localized(hint)}")
        return 1
    write(plain(result.level))
    return 0

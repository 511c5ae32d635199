"""`deck watch`: show everything in a domain on the screen; nothing is started or stopped."""

from __future__ import annotations

import os
from argparse import Namespace

from cli.commands import Parser, command
from cli.options import add_graph, add_screen
from cli.screen import has_terminal
from text.i18n import _
from text.output import say_error
from tui.session.requests import OpenRequest, WatchRequest


def _watch_options(parser: Parser) -> None:
    add_graph(parser, _("ROS domain; by default ROS_DOMAIN_ID, else one of your own"))
    add_screen(parser)
    parser.epilog = _("Deck starts and stops nothing here.")


@command("watch", _watch_options)
def watch_command(options: Namespace) -> int:
    from launcher.domain.domain import choose_domain

    domain = choose_domain(options.domain, None, os.environ)
    if not has_terminal():
        say_error(_("watch needs a terminal; `deck record` works without one"))
        return 2
    from tui.live import run_live

    order = OpenRequest(watch=WatchRequest(domain, options.discovery or "localhost"), wall=options.wall)
    return run_live(order, options.lang, options.bandwidth)

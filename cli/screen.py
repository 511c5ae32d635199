"""`deck`, `deck attach` and `deck watch`: the screen, if there is a terminal to draw it on."""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from pathlib import Path

from cli.commands import COMMANDS, HELP, OPEN, Parser, command
from cli.options import add_graph, add_running, add_screen
from launcher.domain.domain import choose_domain
from launcher.errors import ProfileNotFoundError, UsageError
from launcher.profile.catalog import find_profile
from text.i18n import _
from text.output import say_error, write
from text.sentences import say
from text.suggestions import nearest


@command(OPEN)
def open_command(options: Namespace) -> int:
    """Show the screen; without a terminal, behave like `deck run`."""
    if options.version:
        from importlib import metadata

        write(f"deck {metadata.version('deck-robot')}")
        return 0
    profile = None if options.profile is None else profile_or_command(options.profile)
    if not has_terminal():
        return _without_screen(options)
    from tui.live import run_live
    from tui.session.requests import OpenRequest

    overrides = tuple(options.overrides)
    request = OpenRequest(profile, None, options.hardware, overrides, options.domain, wall=options.wall)
    return run_live(request, options.lang, options.bandwidth, options.pixels)


def profile_or_command(name: str) -> Path:
    """Return the file of the profile; any other word may be a mistyped command.

    Raises:
        UsageError: if there is no such profile; it suggests a similar command.
    """
    try:
        return find_profile(name)
    except ProfileNotFoundError as error:
        command = nearest(name, (*COMMANDS, HELP))
        if not command or error.near:
            raise
        words = say("no profile and no command {name!r}; did you mean `deck {command}`?", name=name, command=command)
        raise UsageError(words) from error


@command("attach", add_running, add_screen)
def attach_command(options: Namespace) -> int:
    if not has_terminal():
        say_error(_("attach needs a terminal; `deck ps` and `deck logs NODE -f` work without one"))
        return 2
    from launcher.client.running import find_running

    # A wrong name is reported before the screen is opened.
    session = find_running(options.name).session
    from tui.live import run_live
    from tui.session.requests import OpenRequest

    request = OpenRequest(attach=options.name or session.name, wall=options.wall)
    return run_live(request, options.lang, options.bandwidth, options.pixels)


def _watch_options(parser: Parser) -> None:
    add_graph(parser, _("ROS domain; by default ROS_DOMAIN_ID, else one of your own"))
    parser.epilog = _("Deck starts and stops nothing here.")


@command("watch", _watch_options, add_screen)
def watch_command(options: Namespace) -> int:
    domain = choose_domain(options.domain, None, os.environ)
    if not has_terminal():
        say_error(_("watch needs a terminal; `deck record` works without one"))
        return 2
    from tui.live import run_live
    from tui.session.requests import OpenRequest, WatchRequest

    order = OpenRequest(watch=WatchRequest(domain, options.discovery or "localhost"), wall=options.wall)
    return run_live(order, options.lang, options.bandwidth, options.pixels)


def has_terminal() -> bool:
    """Whether a screen can be drawn and keys can be read."""
    streams = (sys.stdin, sys.stdout)
    return all(stream is not None and stream.isatty() for stream in streams) and os.environ.get("TERM", "") not in (
        "",
        "dumb",
    )


def _without_screen(options: Namespace) -> int:
    if options.profile is None:
        say_error(_("no terminal for the screen; name a profile: deck run 09-brain (deck list)"))
        return 2
    from launcher.client.start import StartingSupervisor

    with StartingSupervisor() as options.supervisor:
        from cli.run import run_command

        options.seconds, options.json = None, False
        return run_command(options)

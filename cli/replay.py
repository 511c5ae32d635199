"""`deck replay`: show a recording on the screen, without robot or ROS, or list recordings."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cli.commands import command
from cli.options import add_graph, add_screen, rate, seconds
from cli.recordings import find_recording, list_recordings
from cli.screen import has_terminal
from launcher.errors import UsageError
from text.i18n import _, localized
from text.output import say_error
from text.sentences import say
from tui.session.requests import OpenRequest, ReplayRequest

if TYPE_CHECKING:
    from argparse import Namespace
    from pathlib import Path

    from cli.commands import Parser


def _replay_options(parser: Parser) -> None:
    parser.add_argument(
        "bag",
        nargs="?",
        metavar=_("BAG"),
        help=_("name, folder with metadata.yaml, or .mcap file; without it, list the recordings"),
    )
    parser.add_argument("--rate", metavar="R", type=rate, default=1.0, help=_("speed factor, 0.1 to 10"))
    parser.add_argument("--loop", action="store_true", help=_("start again at the end"))
    parser.add_argument(
        "--start", metavar="S", type=seconds, default=0.0, help=_("start S seconds after the first message")
    )
    parser.add_argument(
        "--publish",
        action="store_true",
        help=_("publish to the ROS graph instead of opening a screen, but nothing that moves a robot"),
    )
    parser.add_argument("--motion", action="store_true", help=_("with --publish: also what moves a robot"))
    add_graph(parser, _("with --publish: ROS domain; by default that of the running robot"))
    add_screen(parser)


@command("replay", _replay_options)
def replay_command(options: Namespace) -> int:
    """Show a bag on the screen until the user quits, or publish it; return 2 if it is not a bag."""
    if (options.motion or options.domain is not None) and not options.publish:
        raise UsageError(say("--motion and --domain only work with --publish"))
    if options.bag is None:
        return list_recordings()
    bag = find_recording(options.bag)
    if options.publish:
        from cli.replay_publishing import publish_bag

        return publish_bag(bag, options)
    _check(bag, whole=not has_terminal())
    if not has_terminal():
        say_error(_("replay needs a terminal; `deck replay --publish` works without one"))
        return 2
    from tui.live import run_live

    order = ReplayRequest(bag, options.rate, options.loop, options.start)
    return run_live(OpenRequest(replay=order, wall=options.wall), options.lang, options.bandwidth)


def _check(bag: Path, *, whole: bool) -> None:
    """Report a fault of the bag before anything else is printed or shown.

    `whole`: check its contents too, which may take a while; the screen does this itself.
    """
    from graph.bag.errors import BagError
    from graph.bag.files import files_of
    from graph.bag.reading import open_bag

    try:
        if whole:
            with open_bag(bag) as opened:
                for words in filter(None, (*opened.notes, opened.damage)):
                    say_error(localized(words))
        else:
            files_of(bag)
    except BagError as error:
        raise UsageError(error.words) from error

"""Options of `deck record` and `deck replay`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cli.arguments.options import add_graph, add_json, add_screen
from cli.values import folder, rate, seconds
from text.i18n import _

if TYPE_CHECKING:
    from cli.arguments.parser import Parser


def add_record(parser: Parser) -> None:
    """Add the options of `deck record`."""
    parser.add_argument("topics", nargs="*", metavar=_("TOPIC"), help=_("what to record; all topics by default"))
    parser.add_argument("--hidden", action="store_true", help=_("hidden topics too: feedback and status of actions"))
    parser.add_argument("--no-images", dest="images", action="store_false", help=_("all topics without pictures"))
    parser.add_argument("--no-clouds", dest="clouds", action="store_false", help=_("all topics without point clouds"))
    parser.add_argument(
        "-o",
        "--output",
        metavar=_("FOLDER"),
        type=folder,
        help=_(
            "a new folder to record into; by default in DECK_RECORDINGS_DIR, else "
            "~/deck-recordings, named after lesson and time"
        ),
    )
    parser.add_argument("--for", dest="seconds", metavar="S", type=seconds, help=_("stop after S seconds"))
    add_graph(parser, _("ROS domain; by default that of the running robot"))
    add_json(parser)
    parser.epilog = _(
        "Exit code: 0 if the recording is complete, 1 if it broke off or no messages "
        "arrived, 2 if it could not start."
    )


def add_replay(parser: Parser) -> None:
    """Add the options of `deck replay`."""
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

"""Options of `deck view` and `deck foxglove`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cli.arguments.options import add_graph
from cli.values import port
from text.i18n import _

if TYPE_CHECKING:
    from cli.arguments.parser import Parser


def add_view(parser: Parser) -> None:
    """Add the options of `deck view`."""
    where = parser.add_mutually_exclusive_group()
    where.add_argument(
        "--web",
        action="store_true",
        help=_("a page for a browser, as over SSH; by default a window, where there is a display"),
    )
    where.add_argument("--rviz", action="store_true", help=_("RViz2 with the robot's settings, if it is installed"))
    parser.add_argument("--port", metavar="N", type=port, help=_("port of the page; by default 9090 or the next"))
    parser.add_argument("--no-open", dest="open", action="store_false", help=_("do not open the page in a browser"))
    _add_common(parser)
    parser.epilog = _(
        "Exit code: 0 if it was closed, 1 if it broke off, 2 if it could not start: the viewer is "
        "not installed, or the port is taken."
    )


def add_foxglove(parser: Parser) -> None:
    """Add the options of `deck foxglove`."""
    parser.add_argument("--port", metavar="N", type=port, help=_("port to serve at; by default 8765 or the next"))
    _add_common(parser)
    parser.epilog = _(
        "Exit code: 0 if it was stopped, 1 if it broke off, 2 if it could not start: the server "
        "is not installed, or the port is taken."
    )


def _add_common(parser: Parser) -> None:
    add_graph(parser, _("ROS domain; by default that of the running robot"))
    parser.add_argument(
        "--json", action="store_true", help=_("print JSON, for programs, and end with standard input")
    )

"""Options of the commands that start nodes and look at what runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cli.arguments.options import add_graph, add_json, add_profile, add_profile_options, add_running, add_screen
from cli.values import count, seconds
from graph.inner_states import LOG_LEVELS
from text.i18n import _

if TYPE_CHECKING:
    from cli.arguments.parser import Parser


def add_run(parser: Parser) -> None:
    """Add the options of `deck run`."""
    add_profile(parser)
    parser.add_argument(
        "--for", dest="seconds", metavar="S", type=seconds, help=_("stop S seconds after all nodes are ready")
    )
    add_json(parser)
    add_profile_options(parser)
    parser.epilog = _(
        "Ctrl-C stops the nodes, dependants first; a second Ctrl-C does not wait. Exit code: 0 if"
        " every node stayed healthy, 1 if one failed, 2 if nothing could be started."
    )


def add_list(parser: Parser) -> None:
    """Add the options of `deck list`."""
    add_json(parser)


def add_check(parser: Parser) -> None:
    """Add the options of `deck check`."""
    parser.add_argument("profile", nargs="?", metavar=_("PROFILE"), help=_("name or file; all of them by default"))
    parser.add_argument(
        "--preflight",
        action="store_true",
        help=_("check the devices too, with --hardware real: found, permitted, free, answering"),
    )
    add_json(parser)
    add_profile_options(parser)
    parser.epilog = _("Exit code: 0 if everything is all right, else 2. Nothing is moved.")


def add_up(parser: Parser) -> None:
    """Add the options of `deck up`."""
    add_profile(parser)
    add_profile_options(parser)


def add_frames(parser: Parser) -> None:
    """Add the options of `deck frames`."""
    parser.add_argument(
        "--for", dest="seconds", metavar="S", type=seconds, help=_("listen for S seconds; 3 by default")
    )
    add_graph(parser, _("ROS domain; by default that of the running robot"))
    add_json(parser)
    parser.epilog = _(
        "Exit code: 0 if nothing is wrong with the frames, 1 if something is or there are none, 2 "
        "if ROS or the command line cannot be used."
    )


def add_ps(parser: Parser) -> None:
    """Add the options of `deck ps`."""
    add_json(parser)


def add_logs(parser: Parser) -> None:
    """Add the options of `deck logs`."""
    parser.add_argument("node", nargs="?", metavar=_("NODE"), help=_("name of the node; all of them by default"))
    parser.add_argument("-f", "--follow", action="store_true", help=_("keep showing new lines"))
    parser.add_argument(
        "-n", dest="lines", metavar="N", type=count, default=100, help=_("how many past lines, 100 by default")
    )
    parser.add_argument("--profile", metavar=_("NAME"), help=_("which one, if several are running"))


def add_attach(parser: Parser) -> None:
    """Add the options of `deck attach`."""
    add_running(parser)
    add_screen(parser)


def add_watch(parser: Parser) -> None:
    """Add the options of `deck watch`."""
    add_graph(parser, _("ROS domain; by default ROS_DOMAIN_ID, else one of your own"))
    add_screen(parser)
    parser.epilog = _("Deck starts and stops nothing here.")


def add_stop(parser: Parser) -> None:
    """Add the options of `deck stop`."""
    parser.add_argument("name", nargs="?", metavar=_("NAME"), help=_("name of the profile; without it, all stop"))
    parser.epilog = _(
        "Exit code: 0 if all nodes that report on the emergency stop obey it, 1 if that is not "
        "confirmed within seconds. The stop holds until it is released."
    )


def add_level(parser: Parser) -> None:
    """Add the options of `deck level`."""
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


def add_doctor(parser: Parser) -> None:
    """Add the options of `deck doctor`."""
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


def add_diagnostics(parser: Parser) -> None:
    """Add the options of `deck diagnostics`."""
    parser.add_argument(
        "--for", dest="seconds", metavar="S", type=seconds, default=3.0, help=_("listen for S seconds, 3 by default")
    )
    add_graph(parser, _("ROS domain; by default that of the running robot"))
    add_json(parser)
    parser.epilog = _("Exit code: 0 if everything is all right, 1 if anything is not, 2 if nobody says anything.")

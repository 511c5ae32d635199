"""Options of the commands that let models and agents in: model, mcp."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cli.arguments.options import add_graph, add_language, add_running
from cli.values import between, port
from text.i18n import _

if TYPE_CHECKING:
    from cli.arguments.parser import Parser

MCP_PORT = 8730
"""Not that of Foxglove, which may be served beside it."""
"""Where agents find `deck mcp --http`."""


def add_mcp(parser: Parser) -> None:
    """Add the options of `deck mcp`."""
    add_running(parser)
    add_graph(parser, _("ROS domain; by default that of the running robot"))
    parser.add_argument(
        "--approve",
        choices=("never", "ask", "always"),
        default="ask",
        help=_("whether agents drive: never, after the person at the screen is asked (the default), or always"),
    )
    parser.add_argument(
        "--http", action="store_true", help=_("serve agents on this machine by HTTP, not the one that has started it")
    )
    parser.add_argument(
        "--port",
        metavar="N",
        type=port,
        default=MCP_PORT,
        help=_("with --http: the port, {port} by default; 0 takes a free one").format(port=MCP_PORT),
    )
    parser.add_argument(
        "--show-token", action="store_true", help=_("show the token that agents need for --http, and end")
    )
    parser.epilog = _(
        "Limits of speed and distance are in the profile, and no approval lifts them. The agent "
        "finds the robot whenever it runs. Exit code: 0, or 2 if it could not start."
    )


def add_model(parser: Parser) -> None:
    """Add the options of `deck model`."""
    actions = parser.add_subparsers(dest="action", metavar=_("ACTION"))
    about = _("serve a model from a file on this machine, by the protocol of OpenAI")
    serve = actions.add_parser("serve", help=about, description=about, allow_abbrev=False)
    _add_serve(serve)
    add_language(serve)


def _add_serve(parser: Parser) -> None:
    parser.add_argument("file", metavar=_("FILE"), help=_("the model, a GGUF file"))
    parser.add_argument(
        "--mmproj",
        dest="eyes",
        metavar=_("FILE"),
        help=_("for a model that sees: the file beside it that turns pictures into tokens"),
    )
    parser.add_argument(
        "--port", metavar="N", type=port, default=8080, help=_("8080 by default; 0: any that is free")
    )
    parser.add_argument(
        "--host",
        metavar=_("ADDRESS"),
        default="127.0.0.1",
        help=_("for whom: by default this machine only; 0.0.0.0: everybody on the network"),
    )
    parser.add_argument(
        "--context",
        metavar="N",
        type=between(256, 1 << 24),
        help=_(
            "tokens at once, question and answer together: 8192 by default, or what the model was"
            " trained for if that is less"
        ),
    )
    parser.add_argument(
        "--threads", metavar="N", type=between(1, 512), help=_("by default one less than there are cores")
    )
    parser.add_argument("--verbose", action="store_true", help=_("show the log of llama.cpp"))
    parser.epilog = _(
        "Runs until Ctrl-C, with llama.cpp inside. Exit code: 0 when it was ended, 1 if llama.cpp"
        " broke off, 2 if it could not start."
    )

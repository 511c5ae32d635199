"""Options that several commands share, and mean the same by."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cli.values import bandwidth, domain, whole
from text.i18n import LANGUAGES, _

if TYPE_CHECKING:
    from cli.commands import Parser


def add_profile(parser: Parser) -> None:
    """Add the name of a profile, which has to be given."""
    parser.add_argument("profile", metavar=_("PROFILE"), help=_("name, lesson number or file: 09-brain"))


def add_profile_options(parser: Parser) -> None:
    """Add what changes a profile: its hardware, its parameters, its domain."""
    parser.add_argument(
        "--hardware",
        choices=("mock", "real"),
        default="mock",
        help=_("which nodes to start: mocks (the default) or those of the real robot"),
    )
    parser.add_argument(
        "--set",
        dest="overrides",
        metavar=_("NODE.PARAM=VALUE"),
        action="append",
        default=[],
        help=_("a parameter of a node, the value as in YAML; may be repeated"),
    )
    add_domain(parser, _("ROS domain, 0 to 232, preferably 1 to 101"))


def add_domain(parser: Parser, help_text: str) -> None:
    """Add the ROS domain; what it is by default differs."""
    parser.add_argument("--domain", metavar="N", type=domain, help=help_text)


def add_graph(parser: Parser, help_text: str) -> None:
    """Add the ROS domain, and how far to look for nodes: what joins a graph that somebody runs."""
    add_domain(parser, help_text)
    parser.add_argument(
        "--discovery",
        choices=("localhost", "subnet"),
        help=_(
            "look on this machine only, or on the network too; by default as the running robot does, else localhost"
        ),
    )


def add_screen(parser: Parser) -> None:
    """Add what the screen begins with, and the limit for its pictures."""
    parser.add_argument(
        "--wall", action="store_true", help=_("begin with the wall: big numbers and a big picture, for a projector")
    )
    parser.add_argument(
        "--bandwidth",
        metavar="KB",
        type=bandwidth,
        help=_("limit for pictures in the terminal, kB/s, or off; by default 40 over SSH, else off"),
    )


def add_json(parser: Parser) -> None:
    """Add the output for programs."""
    parser.add_argument("--json", action="store_true", help=_("print JSON, for programs"))


def add_language(parser: Parser) -> None:
    """Add the language."""
    parser.add_argument("--lang", choices=LANGUAGES, help=_("language; by default that of the locale"))


def add_running(parser: Parser) -> None:
    """Add the name of a running profile, for when there are several."""
    parser.add_argument("name", nargs="?", metavar=_("NAME"), help=_("name of the profile, if several are running"))


def add_seed(parser: Parser, words: str = "") -> None:
    """Add the number that draws the values of tasks; `words`: the help, if it is not as usual."""
    parser.add_argument(
        "--seed",
        metavar="N",
        type=whole,
        default=0,
        help=words or _("draw the values from this number; by default another one in each run"),
    )

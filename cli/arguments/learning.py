"""Options of the commands for learners and teachers: new, lesson, grade, shell."""

from __future__ import annotations

from typing import TYPE_CHECKING

from cli.arguments.options import add_domain, add_graph, add_seed
from cli.values import at_once, folder, seconds
from course.grade.defaults import FORMATS, WITHIN_S
from text.i18n import _

if TYPE_CHECKING:
    from cli.arguments.parser import Parser


def add_new(parser: Parser) -> None:
    """Add the options of `deck new`."""
    parser.add_argument("lesson", nargs="?", metavar=_("LESSON"), help=_("name or number of the lesson"))
    parser.add_argument("--node", metavar=_("NAME"), help=_("instead: an empty node of this name, and its profile"))
    parser.add_argument(
        "--again",
        action="store_true",
        help=_("begin anew where there are files of yours, which are kept as copies (.1)"),
    )
    parser.epilog = _("The folder is in ~/deck-course, or where DECK_COURSE says.")


def add_lesson(parser: Parser) -> None:
    """Add the options of `deck lesson`."""
    parser.add_argument("action", choices=("check", "new"))
    parser.add_argument("lessons", nargs="*", metavar=_("LESSON"), help=_("name, number or folder; all by default"))
    parser.add_argument("--jobs", metavar="N", type=at_once, default=2, help=_("how many runs at once, 2 by default"))
    add_seed(parser)
    parser.epilog = _(
        "check: the starter must fail, the solution pass, and each mistake in wrong/STEP/ be caught"
        " at its step. Exit code: 0 if so, else 1."
    )


def add_grade(parser: Parser) -> None:
    """Add the options of `deck grade`."""
    parser.add_argument("lesson", metavar=_("LESSON"), help=_("name, number or folder"))
    parser.add_argument(
        "folders",
        nargs="*",
        metavar=_("FOLDER"),
        help=_("with a learner's files; by default your own of this lesson, or the current one"),
    )
    parser.add_argument(
        "--format",
        choices=FORMATS,
        help=_("write the grades for a program; gradescope and classroom50: of one folder"),
    )
    parser.add_argument(
        "--output", metavar=_("FILE"), help=_("write them into this file, and what people read to standard output")
    )
    parser.add_argument(
        "--bag", metavar=_("DIR"), type=folder, help=_("keep a recording of each folder in this one, as evidence")
    )
    parser.add_argument(
        "--jobs", metavar="N", type=at_once, default=1, help=_("how many folders at once, 1 by default")
    )
    parser.add_argument(
        "--timeout",
        dest="within",
        metavar="S",
        type=seconds,
        default=WITHIN_S,
        help=_("how long a folder may take, 180 s by default"),
    )
    add_domain(parser, _("ROS domain, with one job; by default one that nobody is in"))
    add_seed(parser, _("draw the values from this number; by default one that is made of the files"))
    parser.epilog = _(
        "The folders are left as they are. Exit code: 0 if all steps of all folders have passed, 1"
        " if not, 2 for a wrong request, 3 if a folder could not be graded; with --format"
        " classroom50 also 0 if steps have failed."
    )


def add_shell(parser: Parser) -> None:
    """Add the options of `deck shell`."""
    parser.add_argument("profile", nargs="?", metavar=_("PROFILE"), help=_("by default the lesson that is running"))
    parser.add_argument("-c", dest="line", metavar=_("LINE"), help=_("run this command line and end"))
    add_graph(parser, _("ROS domain; by default that of the running robot"))
    parser.epilog = _("The shell is that of SHELL. The exit code is that of the shell or command.")

"""`deck new`: the learner's folder of a lesson, or of an empty node."""

from __future__ import annotations

import shlex
from argparse import Namespace

from cli.commands import Parser, command
from course.folder.folder import NewFolder, new_folder, new_node
from course.lessons.catalog import find_lesson
from launcher.errors import UsageError
from launcher.profile.defaults import shown
from text.i18n import _
from text.output import write
from text.plain import plain
from text.program import deck_command
from text.sentences import say


def _new_options(parser: Parser) -> None:
    parser.add_argument("lesson", nargs="?", metavar=_("LESSON"), help=_("name or number of the lesson"))
    parser.add_argument("--node", metavar=_("NAME"), help=_("instead: an empty node of this name, and its profile"))
    parser.add_argument(
        "--again",
        action="store_true",
        help=_("begin anew where there are files of yours, which are kept as copies (.1)"),
    )
    parser.epilog = _("The folder is in ~/deck-course, or where DECK_COURSE says.")


@command("new", _new_options)
def new_command(options: Namespace) -> int:
    if bool(options.lesson) == bool(options.node):
        raise UsageError(say("write deck new LESSON or deck new --node NAME"))
    made = new_node(options.node) if options.node else new_folder(find_lesson(options.lesson), again=options.again)
    tell(made)
    return 0


def tell(made: NewFolder) -> None:
    for file in made.files:
        write(_("made {path}").format(path=plain(shown(file))))
    for copy in made.kept:
        write(_("kept yours as {path}").format(path=plain(shown(copy))))
    if not made.files:
        write(_("all of it is there already: {path}").format(path=plain(shown(made.path))))
    path = plain(shlex.quote(shown(made.path)))
    write(_("next: {deck} {path}").format(deck=plain(deck_command()), path=path))

"""The commands of `deck`, and which of them a command line means.

`deck PROFILE` needs no command word, so the word is looked for first, and each command has its own
parser.
"""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from cli.arguments import learning, recording, running, thinking, viewing
from cli.arguments.options import add_language, add_profile_options, add_running, add_screen
from cli.arguments.parser import Parser
from text.i18n import N_, _

if TYPE_CHECKING:
    from collections.abc import Sequence

OPEN = "open"
"""The command that stands for no command word: the screen."""
COMMANDS = {
    "run": N_("start a profile without a screen: prefixed logs, then a summary"),
    "list": N_("list the profiles with their titles"),
    "check": N_("report errors in a profile: file:line:column"),
    "up": N_("start a profile in the background"),
    "ps": N_("show what is running in the background"),
    "logs": N_("show the log of a node running in the background"),
    "attach": N_("open the screen of a profile running in the background"),
    "down": N_("stop a profile running in the background"),
    "stop": N_("stop a running robot at once: the emergency stop, without ROS"),
    "watch": N_("open the screen on nodes that others have started in a ROS domain"),
    "level": N_("show or set from which severity on a running node logs"),
    "frames": N_("print the tree of frames and what is wrong with it"),
    "mcp": N_("let agents look at the robot, propose, and drive only with consent (MCP)"),
    "record": N_("record topics of running nodes into a folder that `ros2 bag` can read"),
    "replay": N_("open the screen on a recording, without a robot"),
    "view": N_("show the running robot in 3D: a window, or a page for a browser"),
    "foxglove": N_("let Foxglove look at the running robot"),
    "new": N_("make your own folder for a lesson, to write its nodes in"),
    "lesson": N_("check a lesson that you have written, or begin one"),
    "grade": N_("grade the files of folders by the steps of a lesson, whatever they do"),
    "model": N_("a language model on this machine, for Deck to ask"),
    "shell": N_("open a shell in the lesson's domain, with ros2, colcon and Deck's Python"),
    "diagnostics": N_("show what drivers and others say on /diagnostics, as a tree"),
    "doctor": N_("check what is installed, which ROS, which ports, and say how to fix what is missing"),
}
HELP = "help"
"""`deck help` and `deck help run` are `deck --help` and `deck run --help`."""
WITH_VALUE = ("--hardware", "--set", "--domain", "--discovery", "--bandwidth", "--lang")
"""Options that may come before the command word."""
_ADD = {
    "run": running.add_run,
    "list": running.add_list,
    "check": running.add_check,
    "up": running.add_up,
    "ps": running.add_ps,
    "logs": running.add_logs,
    "attach": running.add_attach,
    "down": add_running,
    "stop": running.add_stop,
    "watch": running.add_watch,
    "level": running.add_level,
    "frames": running.add_frames,
    "mcp": thinking.add_mcp,
    "record": recording.add_record,
    "replay": recording.add_replay,
    "view": viewing.add_view,
    "foxglove": viewing.add_foxglove,
    "new": learning.add_new,
    "lesson": learning.add_lesson,
    "grade": learning.add_grade,
    "model": thinking.add_model,
    "shell": learning.add_shell,
    "diagnostics": running.add_diagnostics,
    "doctor": running.add_doctor,
}


def split(arguments: Sequence[str]) -> tuple[str, list[str]]:
    """Return the command word, `open` if there is none, and the remaining arguments."""
    skip = False
    for index, word in enumerate(arguments):
        if skip:
            skip = False
        elif word in WITH_VALUE:
            skip = True
        elif word in COMMANDS:
            return word, [*arguments[:index], *arguments[index + 1 :]]
        elif word == HELP:
            command, rest = split([*arguments[:index], *arguments[index + 1 :]])
            return command, [*rest, "--help"]
        elif not word.startswith("-"):
            break
    return OPEN, list(arguments)


def wanted_language(arguments: Sequence[str]) -> str | None:
    """Return the value of `--lang` before parsing, because errors must use that language too."""
    for word, following in zip(arguments, [*arguments[1:], ""], strict=False):
        if word == "--lang":
            return following
        if word.startswith("--lang="):
            return word.partition("=")[2]
    return None


def parser_of(command: str) -> Parser:
    """Return the parser of a command."""
    if command == OPEN:
        return _open_parser()
    parser = Parser(prog=f"deck {command}", description=_(COMMANDS[command]), allow_abbrev=False)
    _ADD[command](parser)
    add_language(parser)
    return parser


def _open_parser() -> Parser:
    lines = [f"  {name:<11} {_(help_text)}" for name, help_text in COMMANDS.items()]
    parser = Parser(
        prog="deck",
        usage=_("deck [PROFILE] [options]\n       deck COMMAND ..."),
        description=_("One screen for the lessons of ROS 2. Without a profile it lets you pick one."),
        epilog=_("commands (for help: deck COMMAND --help):") + "\n" + "\n".join(lines),
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument("profile", nargs="?", metavar=_("PROFILE"), help=_("name, lesson number or file: 09-brain"))
    add_profile_options(parser)
    add_screen(parser)
    add_language(parser)
    parser.add_argument("--version", action="store_true", help=_("show the version and exit"))
    return parser

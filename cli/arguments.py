"""The arguments of `deck`: its commands, their options, and help in both languages.

`deck PROFILE` needs no command word, so the word is looked for first, and each command has its own
parser.
"""

from __future__ import annotations

import argparse
from typing import IO, TYPE_CHECKING, NoReturn

from cli.values import (
    at_once,
    bandwidth,
    between,
    count,
    domain,
    folder,
    port,
    rate,
    seconds,
    whole,
)
from course.grade.defaults import FORMATS, WITHIN_S
from text.i18n import LANGUAGES, N_, _, ngettext
from text.output import harmless

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
    "watch": N_("open the screen on nodes that others have started in a ROS domain"),
    "mcp": N_("let agents look at the robot, propose, and drive only with consent (MCP)"),
    "record": N_("record topics of running nodes into a folder that `ros2 bag` can read"),
    "replay": N_("open the screen on a recording, without a robot"),
    "new": N_("make a folder of one's own for a lesson, to write its nodes in"),
    "lesson": N_("prove a lesson of one's own, or begin one"),
    "grade": N_("grade the files of folders by the steps of a lesson, whatever they do"),
    "model": N_("a language model on this machine, for Deck to ask"),
    "shell": N_("open a shell in the lesson's domain, with ros2, colcon and Deck's Python"),
    "doctor": N_(
        "check what is installed, which ROS, which ports, and say how to fix what is missing"
    ),
}
MCP_PORT = 8765
"""Where agents find `deck mcp --http`."""
HELP = "help"
"""`deck help` and `deck help run` are `deck --help` and `deck run --help`."""
WITH_VALUE = ("--hardware", "--set", "--domain", "--discovery", "--bandwidth", "--lang")
"""Options that may come before the command word."""


class Parser(argparse.ArgumentParser):
    """A parser that uses the language of the screen and refers to the help."""

    def _print_message(self, message: str, file: IO[str] | None = None) -> None:  # type: ignore[override]
        """Never echo arguments unescaped: they may have been pasted."""
        super()._print_message(harmless(message), file)

    def error(self, message: str) -> NoReturn:
        """Exit with 2 after saying what is wrong and where the help is."""
        self.exit(
            2,
            f"{self.prog}: {message}\n"
            + _("for help: {prog} --help").format(prog=self.prog)
            + "\n",
        )


ARGPARSE = (
    N_("usage: "),
    N_("positional arguments"),
    N_("options"),
    N_("optional arguments"),
    N_("show this help message and exit"),
    N_("the following arguments are required: %s"),
    N_("unrecognized arguments: %s"),
    N_("argument %(argument_name)s: %(message)s"),
    N_("invalid choice: %(value)r (choose from %(choices)s)"),
    N_("invalid choice: %(value)s (choose from %(choices)s)"),
    N_("expected one argument"),
    N_("ambiguous option: %(option)s could match %(matches)s"),
    N_("ignored explicit argument %r"),
)
"""The messages of argparse in Python 3.10 to 3.13, marked for the catalogue."""


def speak() -> None:
    """Make argparse look up its messages in our catalogue."""
    argparse._ = _  # type: ignore[attr-defined]
    argparse.ngettext = ngettext  # type: ignore[attr-defined]


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
    _add_language(parser)
    return parser


def _open_parser() -> Parser:
    lines = [f"  {name:<8} {_(help_text)}" for name, help_text in COMMANDS.items()]
    parser = Parser(
        prog="deck",
        usage=_("deck [PROFILE] [options]\n       deck COMMAND ..."),
        description=_(
            "One screen for the lessons of ROS 2. Without a profile it lets you pick one."
        ),
        epilog=_("commands (for help: deck COMMAND --help):") + "\n" + "\n".join(lines),
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    parser.add_argument(
        "profile", nargs="?", metavar=_("PROFILE"), help=_("name, lesson number or file: 09-brain")
    )
    _add_profile_options(parser)
    _add_bandwidth(parser)
    _add_language(parser)
    parser.add_argument("--version", action="store_true", help=_("show the version and exit"))
    return parser


def _add_run(parser: Parser) -> None:
    _add_profile(parser)
    parser.add_argument(
        "--for",
        dest="seconds",
        metavar="S",
        type=seconds,
        help=_("stop S seconds after all nodes are ready"),
    )
    _add_json(parser)
    _add_profile_options(parser)
    parser.epilog = _(
        "Ctrl-C stops the nodes, dependants first; a second Ctrl-C does not wait. Exit code: 0 if"
        " every node stayed healthy, 1 if one failed, 2 if nothing could be started."
    )


def _add_list(parser: Parser) -> None:
    _add_json(parser)


def _add_check(parser: Parser) -> None:
    parser.add_argument(
        "profile", nargs="?", metavar=_("PROFILE"), help=_("name or file; all of them by default")
    )
    parser.add_argument(
        "--preflight",
        action="store_true",
        help=_("check the devices too, with --hardware real: found, permitted, free, answering"),
    )
    _add_json(parser)
    _add_profile_options(parser)
    parser.epilog = _("Exit code: 0 if everything is all right, else 2. Nothing is moved.")


def _add_up(parser: Parser) -> None:
    _add_profile(parser)
    _add_profile_options(parser)


def _add_ps(parser: Parser) -> None:
    _add_json(parser)


def _add_logs(parser: Parser) -> None:
    parser.add_argument(
        "node", nargs="?", metavar=_("NODE"), help=_("name of the node; all of them by default")
    )
    parser.add_argument("-f", "--follow", action="store_true", help=_("keep showing new lines"))
    parser.add_argument(
        "-n",
        dest="lines",
        metavar="N",
        type=count,
        default=100,
        help=_("how many past lines, 100 by default"),
    )
    parser.add_argument("--profile", metavar=_("NAME"), help=_("which one, if several are running"))


def _add_running(parser: Parser) -> None:
    parser.add_argument(
        "name", nargs="?", metavar=_("NAME"), help=_("name of the profile, if several are running")
    )


def _add_attach(parser: Parser) -> None:
    _add_running(parser)
    _add_bandwidth(parser)


def _add_watch(parser: Parser) -> None:
    parser.add_argument(
        "--domain",
        metavar="N",
        type=domain,
        help=_("ROS domain; by default ROS_DOMAIN_ID, else one of your own"),
    )
    parser.add_argument(
        "--discovery",
        choices=("localhost", "subnet"),
        default="localhost",
        help=_("look on this machine only (the default) or on the network too"),
    )
    _add_bandwidth(parser)
    parser.epilog = _("Deck starts and stops nothing here.")


def _add_mcp(parser: Parser) -> None:
    _add_running(parser)
    parser.add_argument(
        "--domain",
        metavar="N",
        type=domain,
        help=_("ROS domain; by default that of the running robot"),
    )
    parser.add_argument(
        "--approve",
        choices=("never", "ask", "always"),
        default="ask",
        help=_(
            "whether agents drive: never, after the person at the screen is asked (the default), "
            "or always"
        ),
    )
    parser.add_argument(
        "--http",
        action="store_true",
        help=_("serve agents on this machine by HTTP, not the one that has started it"),
    )
    parser.add_argument(
        "--port",
        metavar="N",
        type=port,
        default=MCP_PORT,
        help=_("with --http: the port, {port} by default; 0 takes a free one").format(
            port=MCP_PORT
        ),
    )
    parser.add_argument(
        "--show-token",
        action="store_true",
        help=_("show the token that agents need for --http, and end"),
    )
    parser.epilog = _(
        "Limits of speed and distance are in the profile, and no approval lifts them. The agent "
        "finds the robot whenever it runs. Exit code: 0, or 2 if it could not start."
    )


def _add_record(parser: Parser) -> None:
    parser.add_argument(
        "topics", nargs="*", metavar=_("TOPIC"), help=_("what to record; all topics by default")
    )
    parser.add_argument(
        "--hidden", action="store_true", help=_("hidden topics too: feedback and status of actions")
    )
    parser.add_argument(
        "--no-images", dest="images", action="store_false", help=_("all topics without pictures")
    )
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
    parser.add_argument(
        "--for", dest="seconds", metavar="S", type=seconds, help=_("stop after S seconds")
    )
    parser.add_argument(
        "--domain",
        metavar="N",
        type=domain,
        help=_("ROS domain; by default that of the running robot"),
    )
    _add_json(parser)
    parser.epilog = _(
        "Exit code: 0 if the recording is complete, 1 if it broke off or no messages "
        "arrived, 2 if it could not start."
    )


def _add_replay(parser: Parser) -> None:
    parser.add_argument(
        "bag",
        nargs="?",
        metavar=_("BAG"),
        help=_("name, folder with metadata.yaml, or .mcap file; without it, list the recordings"),
    )
    parser.add_argument(
        "--rate", metavar="R", type=rate, default=1.0, help=_("speed factor, 0.1 to 10")
    )
    parser.add_argument("--loop", action="store_true", help=_("start again at the end"))
    parser.add_argument(
        "--start",
        metavar="S",
        type=seconds,
        default=0.0,
        help=_("start S seconds after the first message"),
    )
    parser.add_argument(
        "--publish",
        action="store_true",
        help=_(
            "publish to the ROS graph instead of opening a screen, but nothing that moves a robot"
        ),
    )
    parser.add_argument(
        "--motion", action="store_true", help=_("with --publish: also what moves a robot")
    )
    parser.add_argument(
        "--domain",
        metavar="N",
        type=domain,
        help=_("with --publish: ROS domain; by default that of the running robot"),
    )
    _add_bandwidth(parser)


def _add_new(parser: Parser) -> None:
    parser.add_argument(
        "lesson", nargs="?", metavar=_("LESSON"), help=_("name or number of the lesson")
    )
    parser.add_argument(
        "--node", metavar=_("NAME"), help=_("instead: an empty node of this name, and its profile")
    )
    parser.epilog = _(
        "The folder is in ~/deck-course, or where DECK_COURSE says. Nothing that is there is"
        " overwritten without a copy."
    )


def _add_lesson(parser: Parser) -> None:
    parser.add_argument("action", choices=("check", "new"))
    parser.add_argument(
        "lessons", nargs="*", metavar=_("LESSON"), help=_("name, number or folder; all by default")
    )
    parser.add_argument(
        "--jobs",
        metavar="N",
        type=at_once,
        default=2,
        help=_("how many runs at once, 2 by default"),
    )
    _add_seed(parser)
    parser.epilog = _(
        "check: the starter must fail, the solution pass, and each mistake in wrong/STEP/ be caught"
        " at its step. Exit code: 0 if so, else 1."
    )


def _add_seed(parser: Parser) -> None:
    parser.add_argument(
        "--seed",
        metavar="N",
        type=whole,
        default=0,
        help=_("draw the values from this number; by default another one in each run"),
    )


def _add_grade(parser: Parser) -> None:
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
        "--output",
        metavar=_("FILE"),
        help=_("write them into this file, and what people read to standard output"),
    )
    parser.add_argument(
        "--bag",
        metavar=_("DIR"),
        type=folder,
        help=_("keep a recording of each folder in this one, as evidence"),
    )
    parser.add_argument(
        "--jobs",
        metavar="N",
        type=at_once,
        default=1,
        help=_("how many folders at once, 1 by default"),
    )
    parser.add_argument(
        "--timeout",
        dest="within",
        metavar="S",
        type=seconds,
        default=WITHIN_S,
        help=_("how long a folder may take, 180 s by default"),
    )
    parser.add_argument(
        "--domain",
        metavar="N",
        type=domain,
        help=_("ROS domain, with one job; by default one that nobody is in"),
    )
    _add_seed(parser)
    parser.epilog = _(
        "The folders are left as they are. Exit code: 0 if all steps of all folders have passed, 1"
        " if not, 2 for a wrong request, 3 if a folder could not be graded; with --format"
        " classroom50 also 0 if steps have failed."
    )


def _add_model(parser: Parser) -> None:
    actions = parser.add_subparsers(dest="action", metavar=_("ACTION"))
    about = _("serve a model from a file on this machine, by the protocol of OpenAI")
    serve = actions.add_parser("serve", help=about, description=about, allow_abbrev=False)
    _add_serve(serve)
    _add_language(serve)


def _add_serve(parser: Parser) -> None:
    parser.add_argument("file", metavar=_("FILE"), help=_("the model, a GGUF file"))
    parser.add_argument(
        "--mmproj",
        dest="eyes",
        metavar=_("FILE"),
        help=_("for a model that sees: the file beside it that turns pictures into tokens"),
    )
    parser.add_argument(
        "--port",
        metavar="N",
        type=port,
        default=8080,
        help=_("8080 by default; 0: any that is free"),
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
        "--threads",
        metavar="N",
        type=between(1, 512),
        help=_("by default one less than there are cores"),
    )
    parser.add_argument("--verbose", action="store_true", help=_("show the log of llama.cpp"))
    parser.epilog = _(
        "Runs until Ctrl-C, with llama.cpp inside. Exit code: 0 when it was ended, 1 if llama.cpp"
        " broke off, 2 if it could not start."
    )


def _add_shell(parser: Parser) -> None:
    parser.add_argument(
        "profile", nargs="?", metavar=_("PROFILE"), help=_("by default the lesson that is running")
    )
    parser.add_argument(
        "-c", dest="line", metavar=_("LINE"), help=_("run this command line and end")
    )
    parser.add_argument(
        "--domain",
        metavar="N",
        type=domain,
        help=_("ROS domain; by default that of the running robot"),
    )
    parser.epilog = _("The shell is that of SHELL. The exit code is that of the shell or command.")


def _add_doctor(parser: Parser) -> None:
    parser.add_argument(
        "what", nargs="?", choices=("llm",), help=_("llm: ask the language model for a test")
    )
    _add_json(parser)
    parser.epilog = _("Exit code: 0, or 1 if something essential is missing.")


_ADD = {
    "run": _add_run,
    "list": _add_list,
    "check": _add_check,
    "up": _add_up,
    "ps": _add_ps,
    "logs": _add_logs,
    "attach": _add_attach,
    "down": _add_running,
    "watch": _add_watch,
    "mcp": _add_mcp,
    "record": _add_record,
    "replay": _add_replay,
    "new": _add_new,
    "lesson": _add_lesson,
    "grade": _add_grade,
    "model": _add_model,
    "shell": _add_shell,
    "doctor": _add_doctor,
}


def _add_profile(parser: Parser) -> None:
    parser.add_argument(
        "profile", metavar=_("PROFILE"), help=_("name, lesson number or file: 09-brain")
    )


def _add_profile_options(parser: Parser) -> None:
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
    parser.add_argument(
        "--domain", metavar="N", type=domain, help=_("ROS domain, 0 to 232, preferably 1 to 101")
    )


def _add_bandwidth(parser: Parser) -> None:
    parser.add_argument(
        "--bandwidth",
        metavar="KB",
        type=bandwidth,
        help=_(
            "limit for pictures in the terminal, kB/s, or off; by default 40 over SSH, else off"
        ),
    )


def _add_json(parser: Parser) -> None:
    parser.add_argument("--json", action="store_true", help=_("print JSON, for programs"))


def _add_language(parser: Parser) -> None:
    parser.add_argument(
        "--lang", choices=LANGUAGES, help=_("language; by default that of the locale")
    )

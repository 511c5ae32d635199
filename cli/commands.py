"""The commands of `deck`, which of them a command line means, and the parser of each.

A command is a function with `@command`, in the module that `COMMANDS` names; that is imported only for this command
or its help. `deck PROFILE` needs no command word, so the word is looked for first.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Coroutine, Sequence
from importlib import import_module
from typing import IO, Any, NamedTuple, NoReturn, TypeAlias, TypeVar

from cli.options import add_language, add_profile_options, add_screen
from launcher.processes.interrupts import held, run
from text.i18n import N_, _, ngettext
from text.output import harmless

Handler: TypeAlias = Callable[[argparse.Namespace], int]
Work: TypeAlias = Callable[[argparse.Namespace], int | Coroutine[Any, Any, int]]
T = TypeVar("T", bound=Work)


class Place(NamedTuple):
    """Where a command is, and what the help says of it."""

    module: str
    help: str
    starts: bool = False
    """Whether it starts a profile: what it runs on begins while its module is imported."""


OPEN = "open"
"""The command that stands for no command word: the screen."""
COMMANDS = {
    "run": Place("cli.run", N_("start a profile without a screen: prefixed logs, then a summary"), starts=True),
    "list": Place("cli.listing", N_("list the profiles with their titles")),
    "check": Place("cli.listing", N_("report errors in a profile: file:line:column")),
    "up": Place("cli.background", N_("start a profile in the background"), starts=True),
    "ps": Place("cli.background", N_("show what is running in the background")),
    "logs": Place("cli.background", N_("show the log of a node running in the background")),
    "attach": Place("cli.screen", N_("open the screen of a profile running in the background")),
    "down": Place("cli.background", N_("stop a profile running in the background")),
    "stop": Place("cli.stop", N_("stop a running robot at once: the emergency stop, without ROS")),
    "watch": Place("cli.screen", N_("open the screen on nodes that others have started in a ROS domain")),
    "level": Place("cli.level", N_("show or set from which severity on a running node logs")),
    "frames": Place("cli.frames", N_("print the tree of frames and what is wrong with it")),
    "mcp": Place("cli.mcp", N_("let agents look at the robot, propose, and drive only with consent (MCP)")),
    "record": Place("cli.record", N_("record topics of running nodes into a folder that `ros2 bag` can read")),
    "replay": Place("cli.replay", N_("open the screen on a recording, without a robot")),
    "view": Place("cli.view", N_("show the running robot in 3D: a window, or a page for a browser")),
    "foxglove": Place("cli.view", N_("let Foxglove look at the running robot")),
    "new": Place("cli.new", N_("make your own folder for a lesson, to write its nodes in")),
    "lesson": Place("cli.lesson", N_("check a lesson that you have written, or begin one")),
    "grade": Place("cli.grade", N_("grade the files of folders by the steps of a lesson, whatever they do")),
    "model": Place("cli.model", N_("a language model on this machine, for Deck to ask")),
    "shell": Place("cli.shell", N_("open a shell in the lesson's domain, with ros2, colcon and Deck's Python")),
    "diagnostics": Place("cli.diagnostics", N_("show what drivers and others say on /diagnostics, as a tree")),
    "doctor": Place(
        "cli.doctor.command",
        N_("check what is installed, which ROS, which ports, and say how to fix what is missing"),
    ),
}
HELP = "help"
"""`deck help` and `deck help run` are `deck --help` and `deck run --help`."""
WITH_VALUE = ("--hardware", "--set", "--domain", "--discovery", "--bandwidth", "--pixels", "--lang")
"""Options that may come before the command word."""
_ANNOUNCED: dict[str, tuple[Sequence[Callable[[Parser], None]], Work]] = {}


def command(name: str, *options: Callable[[Parser], None]) -> Callable[[T], T]:
    """Announce a function as a command, which returns the exit code; `options` declare what it takes."""

    def announced(work: T) -> T:
        _ANNOUNCED[name] = (options, work)
        return work

    return announced


def handler_of(name: str) -> Handler:
    def handle(options: argparse.Namespace) -> int:
        done = _announced(name)[1](options)
        return done if isinstance(done, int) else run(done)

    return handle


def _announced(name: str) -> tuple[Sequence[Callable[[Parser], None]], Work]:
    with held():
        import_module("cli.screen" if name == OPEN else COMMANDS[name].module)
    return _ANNOUNCED[name]


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


def parser_of(name: str) -> Parser:
    if name == OPEN:
        return _open_parser()
    parser = Parser(prog=f"deck {name}", description=_(COMMANDS[name].help), allow_abbrev=False)
    for declare in (*_announced(name)[0], add_language):
        declare(parser)
    return parser


def _open_parser() -> Parser:
    lines = [f"  {name:<11} {_(place.help)}" for name, place in COMMANDS.items()]
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


class Parser(argparse.ArgumentParser):
    """A parser that uses the language of the screen and refers to the help."""

    def _print_message(self, message: str, file: IO[str] | None = None) -> None:  # type: ignore[override]
        """Never echo arguments unescaped: they may have been pasted."""
        super()._print_message(harmless(message), file)

    def error(self, message: str) -> NoReturn:
        """Exit with 2 after saying what is wrong and where the help is."""
        self.exit(2, f"{self.prog}: {message}\n" + _("for help: {prog} --help").format(prog=self.prog) + "\n")


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

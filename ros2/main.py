"""The command line of `ros2`: finds the verb, hands it its options, ends as the real one does."""

from __future__ import annotations

import argparse
import difflib
import os
import signal
import sys
from importlib import import_module
from typing import TYPE_CHECKING, Protocol, cast

from ros2.options import UsageError
from ros2.table import COMMANDS, ELSEWHERE, VERBS, VERBS_ELSEWHERE
from text.output import harmless_output

if TYPE_CHECKING:
    from collections.abc import Sequence

USAGE_ERROR = 2


class Verb(Protocol):
    """A module of `ros2.verbs`."""

    SUMMARY: str
    """One line for `--help`."""

    def arguments(self, parser: argparse.ArgumentParser) -> None:
        """Declare the options."""

    def main(self, args: argparse.Namespace) -> int | str | None:
        """Do it; return the exit code, or an error text, which is the exit code 1."""


def main(argv: Sequence[str]) -> int:
    """Run one command line; return the exit code.

    Whatever others have named, published or answered is printed without what could control the
    terminal or hide in it.
    """
    with harmless_output():
        return _ended(argv)


def _ended(argv: Sequence[str]) -> int:
    try:
        code = _run(list(argv))
        sys.stdout.flush()
    except BrokenPipeError:
        # As in `ros2 topic echo /x | head -1`; Python would complain once more at its end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        return 128 + signal.SIGPIPE
    except KeyboardInterrupt:
        return signal.SIGINT
    except UsageError as error:
        return _failed(str(error), USAGE_ERROR)
    except RuntimeError as error:
        return _failed(str(error))
    if isinstance(code, str):
        return _failed(code)
    return code or 0


def _failed(why: str, code: int = 1) -> int:
    sys.stdout.flush()
    print(why, file=sys.stderr)
    return code


def _run(argv: list[str]) -> int | str | None:
    if not argv or argv[0] in ("-h", "--help"):
        _top().print_help()
        return 0
    command, *rest = argv
    if command.startswith("-"):
        return _top().error(f"unrecognized arguments: {command}")
    if command not in COMMANDS:
        return _unknown("ros2", command, ELSEWHERE.get(command), sorted(COMMANDS))
    return _run_verb(command, rest)


def _run_verb(command: str, rest: list[str]) -> int | str | None:
    verbs = {verb: module for (owner, verb), module in VERBS.items() if owner == command}
    if "" in verbs:
        return _call(verbs[""], f"ros2 {command}", rest)
    # Options of the command itself, as in `ros2 topic --include-hidden-topics list`.
    options = []
    while rest and rest[0].startswith("--include-hidden"):
        options.append(rest.pop(0))
    if not rest or rest[0] in ("-h", "--help"):
        _of_command(command, verbs).print_help()
        return 0
    verb, *rest = rest
    if verb not in verbs:
        where = VERBS_ELSEWHERE.get((command, verb))
        return _unknown(f"ros2 {command}", verb, where, sorted(verbs))
    return _call(verbs[verb], f"ros2 {command} {verb}", [*options, *rest])


def _call(module: str, program: str, argv: list[str]) -> int | str | None:
    verb = _load(module)
    parser = argparse.ArgumentParser(
        prog=program, description=verb.SUMMARY, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    verb.arguments(parser)
    args = parser.parse_args(argv)
    code = verb.main(args)
    if missing := getattr(args, "missing", ""):
        sys.stdout.flush()
        print(f"ros2: {missing}", file=sys.stderr)
        return code or 1
    return code


def _load(module: str) -> Verb:
    return cast("Verb", import_module(f"ros2.verbs.{module}"))


def _top() -> argparse.ArgumentParser:
    return _list_of("ros2", "ros2 is an extensible command-line tool for ROS 2.", COMMANDS)


def _of_command(command: str, verbs: dict[str, str]) -> argparse.ArgumentParser:
    summaries = {verb: _load(module).SUMMARY for verb, module in sorted(verbs.items())}
    return _list_of(f"ros2 {command}", COMMANDS[command], summaries)


def _list_of(program: str, description: str, entries: dict[str, str]) -> argparse.ArgumentParser:
    what, word = ("Commands", "<command>") if program == "ros2" else ("Verbs", "<verb>")
    lines = "".join(f"  {name.ljust(9)}  {text}\n" for name, text in entries.items())
    return argparse.ArgumentParser(
        prog=program,
        usage=f"{program} [-h] Call `{program} {word} -h` for more detailed usage. ...",
        description=description,
        epilog=f"{what}:\n{lines}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )


def _unknown(program: str, word: str, where: str | None, known: list[str]) -> int:
    if where is None:
        near = difflib.get_close_matches(word, known, n=1)
        where = f"did you mean '{near[0]}'?" if near else f"choose from {', '.join(known)}"
        print(f"{program}: there is no '{word}': {where}", file=sys.stderr)
    else:
        print(f"{program}: '{word}' is not in Deck's ros2. {where}", file=sys.stderr)
    return USAGE_ERROR

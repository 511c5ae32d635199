"""The command line of `ros2`: finds the verb, hands it its options, ends as the real one does."""

from __future__ import annotations

import argparse
import difflib
import os
import signal
import sys
from importlib import import_module
from typing import TYPE_CHECKING, Final

from ros2 import elsewhere
from ros2.verb import VERBS, UsageError
from text.output import harmless_output

if TYPE_CHECKING:
    from collections.abc import Sequence

USAGE_ERROR = 2
COMMANDS: Final = {
    "action": "Various action related sub-commands",
    "bag": "Various rosbag related sub-commands",
    "interface": "Show information about ROS interfaces",
    "lifecycle": "Various lifecycle related sub-commands",
    "node": "Various node related sub-commands",
    "param": "Various param related sub-commands",
    "pkg": "Various package related sub-commands",
    "run": "Run a package specific executable",
    "service": "Various service related sub-commands",
    "topic": "Various topic related sub-commands",
}
"""The commands, and what `ros2 --help` says of each."""


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
        return _unknown("ros2", command, elsewhere.COMMANDS.get(command), sorted(COMMANDS))
    return _run_verb(command, rest)


def _run_verb(command: str, rest: list[str]) -> int | str | None:
    import_module(f"ros2.verbs.{command}")
    if command in VERBS:
        return _call(command, rest)
    verbs = {
        name.removeprefix(f"{command} "): each
        for name, each in sorted(VERBS.items())
        if name.startswith(f"{command} ")
    }
    if not rest or rest[0] in ("-h", "--help"):
        summaries = {name: each.summary for name, each in verbs.items()}
        _list_of(f"ros2 {command}", COMMANDS[command], summaries).print_help()
        return 0
    verb, *rest = rest
    if verb not in verbs:
        where = elsewhere.VERBS.get((command, verb))
        return _unknown(f"ros2 {command}", verb, where, sorted(verbs))
    return _call(f"{command} {verb}", rest)


def _call(name: str, argv: list[str]) -> int | str | None:
    verb = VERBS[name]
    parser = argparse.ArgumentParser(
        prog=f"ros2 {name}", description=verb.summary, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    for part in verb.parts:
        part(parser)
    return verb.main(parser.parse_args(argv))


def _top() -> argparse.ArgumentParser:
    return _list_of("ros2", "ros2 is an extensible command-line tool for ROS 2.", COMMANDS)


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

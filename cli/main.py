"""`deck`: finds the command, imports only what it needs, and ends with a meaningful exit code.

0 all went well, 1 something failed, 2 what was asked for cannot be right, 130 interrupted.
"""

from __future__ import annotations

import os
import sys
from importlib import import_module
from typing import TYPE_CHECKING

from cli.arguments import OPEN, parser_of, speak, split, wanted_language
from launcher.errors import LauncherError
from text.i18n import LANGUAGES, detect, said, set_language
from text.output import drop_output, make_streams_safe, say_error

if TYPE_CHECKING:
    from argparse import Namespace
    from collections.abc import Sequence

HANDLERS = {
    "open": ("cli.screen", "open_command"),
    "attach": ("cli.screen", "attach_command"),
    "watch": ("cli.watch", "watch_command"),
    "run": ("cli.run", "run_command"),
    "list": ("cli.listing", "list_command"),
    "check": ("cli.listing", "check_command"),
    "up": ("cli.background", "up_command"),
    "ps": ("cli.background", "ps_command"),
    "logs": ("cli.background", "logs_command"),
    "down": ("cli.background", "down_command"),
    "record": ("cli.record", "record_command"),
    "replay": ("cli.replay", "replay_command"),
    "doctor": ("cli.doctor.command", "doctor_command"),
}
"""Command to module and function: only the module of the command in hand is imported."""
STARTERS = ("run", "up")
"""Commands that start a profile as soon as they have read it."""
INTERRUPTED = 130
READER_GONE = 141
OPENBLAS_PATIENCE = ("OPENBLAS_THREAD_TIMEOUT", "4")
"""Two to this power is how many clock ticks idle threads of numpy spin before they sleep.

rclpy imports numpy, and nothing here has work for its threads: by default they take 0.2 s of CPU
time from every start.
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; return what to exit with."""
    make_streams_safe()
    # For the processes that are started from here as well.
    os.environ.setdefault(*OPENBLAS_PATIENCE)
    words = list(sys.argv[1:] if arguments is None else arguments)
    asked = wanted_language(words)
    set_language(detect(asked if asked in LANGUAGES else None))
    speak()
    command, rest = split(words)
    try:
        options = _parsed(command, rest)
        return options if isinstance(options, int) else _run(command, options)
    except LauncherError as error:
        return complain(error)
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        drop_output()
        return READER_GONE
    except OSError as error:
        drop_output()
        say_error(f"deck: {error}")
        return 1


def _parsed(command: str, words: Sequence[str]) -> Namespace | int:
    """Return what is asked for, or what to exit with: it was help, or something wrong, and is told.

    Raises:
        LauncherError: if a word that is no command stands before what only commands take.
    """
    parser = parser_of(command)
    try:
        if command == OPEN and words[-1:] == ["--help"]:
            _refuse_no_command(parser.parse_known_args(words[:-1])[0].profile)
        options, more = parser.parse_known_args(words)
        if more and command == OPEN:
            _refuse_no_command(options.profile)
        return parser.parse_args(words) if more else options
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else 2


def _refuse_no_command(word: str | None) -> None:
    """Raise a LauncherError if there is a word that is neither a command nor a profile."""
    if word is not None:
        from cli.screen import profile_or_command

        profile_or_command(word)


def complain(error: LauncherError) -> int:
    """Tell an error to standard error; return its exit code."""
    for part in error.args:
        say_error(said(part) if isinstance(part, str) else str(part))
    return error.exit_code


def _run(command: str, options: Namespace) -> int:
    if command not in STARTERS:
        return _handle(command, options)
    from launcher.client.start import StartingSupervisor

    # It has more to import than this process has, and may begin at once.
    with StartingSupervisor() as options.supervisor:
        return _handle(command, options)


def _handle(command: str, options: Namespace) -> int:
    module, function = HANDLERS[command]
    code: int = getattr(import_module(module), function)(options)
    sys.stdout.flush()
    return code

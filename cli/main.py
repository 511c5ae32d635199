"""`deck`: finds the command, imports only what it needs, and ends with a meaningful exit code.

Exit codes: 0 success, 1 a failure, 2 an invalid request, 130 interrupted.
"""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from collections.abc import Sequence
from typing import TYPE_CHECKING

from cli.commands import COMMANDS, OPEN, handler_of, parser_of, speak, split, wanted_language
from launcher.errors import LauncherError
from text.i18n import LANGUAGES, detect, localized, set_language
from text.output import drop_output, make_streams_safe, say_error

if TYPE_CHECKING:
    from launcher.client.start import StartingSupervisor

INTERRUPTED = 130
READER_GONE = 141
OPENBLAS_PATIENCE = ("OPENBLAS_THREAD_TIMEOUT", "4")
"""Idle threads of numpy spin for two to this power clock ticks before they sleep.

rclpy imports numpy, but nothing here uses its threads: by default they cost every start 0.2 s of
CPU time.
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; return the exit code."""
    try:
        make_streams_safe()
        # This also applies to the processes started from here.
        os.environ.setdefault(*OPENBLAS_PATIENCE)
        words = list(sys.argv[1:] if arguments is None else arguments)
        asked = wanted_language(words)
        set_language(detect(asked if asked in LANGUAGES else None))
        speak()
        command, rest = split(words)
        if command == OPEN or not COMMANDS[command].starts or {"-h", "--help"} & {*rest}:
            return _run(command, rest)
        from launcher.client.start import StartingSupervisor

        # It has more to import than this process, so it is started at once.
        with StartingSupervisor() as supervisor:
            return _run(command, rest, supervisor)
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
    """Return the parsed options, or an exit code after showing help or an error.

    Raises:
        LauncherError: if an unknown command word comes before options that only commands have.
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
    """Raise a LauncherError if the word is neither a command nor a profile."""
    if word is not None:
        from cli.screen import profile_or_command

        profile_or_command(word)


def complain(error: LauncherError) -> int:
    """Write an error to standard error; return its exit code."""
    for part in error.args:
        say_error(localized(part) if isinstance(part, str) else str(part))
    return error.exit_code


def _run(command: str, words: Sequence[str], supervisor: StartingSupervisor | None = None) -> int:
    options = _parsed(command, words)
    if isinstance(options, int):
        return options
    options.supervisor = supervisor
    code = handler_of(command)(options)
    sys.stdout.flush()
    return code

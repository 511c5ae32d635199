"""Where the launcher keeps the data of a run, and what outlives it: logs, recordings.

The run directory holds control sockets: it must be the user's own, and nobody else may write to
it. One that Deck makes is closed to all others; one that was there before is never changed.
"""

from __future__ import annotations

import contextlib
import os
import stat
import time
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.errors import RunDirError
from launcher.private_files import make_folder
from text.os_words import os_reason
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Mapping

OWN_RUN_DIR = "DECK_RUN_DIR"
"""Environment variable that keeps the runs of one purpose apart from all others."""


def run_dir() -> Path:
    """Return the run directory, made with mode 0700 if need be.

    `DECK_RUN_DIR`, else `$XDG_RUNTIME_DIR/deck`, else `/tmp/deck-<uid>`.

    Raises:
        RunDirError: if others could plant something there; it is never changed.
    """
    return own_folder(run_path(os.environ))


def found_run_dir() -> Path | None:
    """Return the run directory if there is one, for whoever only looks.

    Raises:
        RunDirError: if others could have planted what is there.
    """
    path = run_path(os.environ)
    try:
        _check_own(path)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise _not_made(path, error) from error
    return path


def log_path() -> Path:
    """Return where the logs are, whether there are any or not.

    `DECK_LOG_DIR`, else `$XDG_STATE_HOME/deck/logs`, else `~/.local/state/deck/logs`.
    """
    chosen = os.environ.get("DECK_LOG_DIR")
    if chosen:
        return Path(chosen)
    from platformdirs import user_state_path  # Whoever only looks for runs does without.

    return user_state_path("deck") / "logs"


def log_dir() -> Path:
    """Return the directory of the logs, made if need be.

    Raises:
        RunDirError: if it cannot be made or written.
    """
    path = log_path()
    try:
        make_folder(path)
    except OSError as error:
        raise _not_made(path, error) from error
    check_writable(path)
    return path


def recordings_path() -> Path:
    """Return the folder of recordings, whether there are any or not: one that people find.

    `DECK_RECORDINGS_DIR`, else `~/deck-recordings`.
    """
    chosen = os.environ.get("DECK_RECORDINGS_DIR")
    return Path(chosen) if chosen else Path.home() / "deck-recordings"


def new_recording(what: str) -> Path:
    """Return where a recording of this robot that begins now goes; the folder is not made."""
    return recordings_path() / f"{Path(what).name}-{time.strftime('%Y-%m-%d-%H-%M-%S')}"


def check_writable(logs: Path) -> None:
    """Raise RunDirError unless files can be made in the directory of the logs."""
    if not os.access(logs, os.W_OK | os.X_OK):
        raise RunDirError(
            say("{path} cannot be written; set DECK_LOG_DIR to a folder of yours", path=logs)
        )


def run_path(environ: Mapping[str, str]) -> Path:
    """Return where the run directory is by these variables, whether it is there or not."""
    chosen = environ.get(OWN_RUN_DIR)
    if chosen:
        return Path(chosen)
    # Not of platformdirs: without a login's own folder it takes another than /tmp/deck-<uid>.
    runtime = Path(environ.get("XDG_RUNTIME_DIR") or "/nonexistent")
    if runtime.is_dir() and runtime.stat().st_uid == os.getuid():
        return runtime / "deck"
    return Path(f"/tmp/deck-{os.getuid()}")


def own_folder(path: Path) -> Path:
    """Make `path` if need be, and make sure that nobody else could plant anything in it.

    Raises:
        RunDirError: if others could, or it cannot be made.
    """
    try:
        make_folder(path.parent)
        with contextlib.suppress(FileExistsError):
            path.mkdir(mode=0o700)
        _check_own(path)
    except OSError as error:
        raise _not_made(path, error) from error
    return path


def _check_own(path: Path) -> None:
    """Raise RunDirError unless it is a folder of the user's that nobody else can write to."""
    found = path.lstat()
    if not stat.S_ISDIR(found.st_mode):
        raise RunDirError(
            say("{path} is not a directory; remove it, or set DECK_RUN_DIR", path=path)
        )
    if found.st_uid != os.getuid():
        raise RunDirError(
            say("{path} belongs to somebody else; set DECK_RUN_DIR to your own", path=path)
        )
    if found.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
        raise RunDirError(
            say(
                "others can write to {path}; set DECK_RUN_DIR to a folder that is yours alone"
                " (one that is not there yet is made so), or chmod go-w {path}",
                path=path,
            )
        )


def _not_made(path: Path, error: OSError) -> RunDirError:
    return RunDirError(say("{path} cannot be made: {reason}", path=path, reason=os_reason(error)))

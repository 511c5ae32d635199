"""Where the launcher keeps the data of a run, and data that outlives it: logs and recordings.

The run directory holds control sockets: it must belong to the user, and nobody else may be able to
write to it. Deck creates it inaccessible to others; an existing one is never changed.
"""

from __future__ import annotations

import contextlib
import os
import stat
import time
from pathlib import Path

from launcher.errors import RunDirError
from launcher.private_files import make_folder
from text.os_words import os_reason
from text.run_path import run_path
from text.sentences import say


def run_dir() -> Path:
    """Return the run directory (see `text.run_path`), created with mode 0700 if necessary.

    Raises:
        RunDirError: if others could write to it; its mode is never changed.
    """
    return own_folder(run_path(os.environ))


def found_run_dir() -> Path | None:
    """Return the run directory if it exists, without creating it.

    Raises:
        RunDirError: if others could have written to it.
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
    """Return the directory of the logs, whether or not it exists.

    `DECK_LOG_DIR`, else `$XDG_STATE_HOME/deck/logs`, else `~/.local/state/deck/logs`.
    """
    chosen = os.environ.get("DECK_LOG_DIR")
    if chosen:
        return Path(chosen)
    from platformdirs import user_state_path  # Not needed for merely finding runs.

    return user_state_path("deck") / "logs"


def log_dir() -> Path:
    """Return the directory of the logs, created if necessary.

    Raises:
        RunDirError: if it cannot be created or written to.
    """
    path = log_path()
    try:
        make_folder(path)
    except OSError as error:
        raise _not_made(path, error) from error
    check_writable(path)
    return path


def recordings_path() -> Path:
    """Return the folder of recordings, whether or not it exists; it is easy for users to find.

    `DECK_RECORDINGS_DIR`, else `~/deck-recordings`.
    """
    chosen = os.environ.get("DECK_RECORDINGS_DIR")
    return Path(chosen) if chosen else Path.home() / "deck-recordings"


def new_recording(what: str) -> Path:
    """Return the path for a recording that begins now; the folder is not created."""
    return recordings_path() / f"{Path(what).name}-{time.strftime('%Y-%m-%d-%H-%M-%S')}"


def check_writable(logs: Path) -> None:
    """Raise RunDirError unless files can be created in the directory of the logs."""
    if not os.access(logs, os.W_OK | os.X_OK):
        raise RunDirError(say("{path} cannot be written; set DECK_LOG_DIR to a folder of yours", path=logs))


def own_folder(path: Path) -> Path:
    """Create `path` if necessary, and make sure that nobody else can write to it.

    Raises:
        RunDirError: if others can, or it cannot be created.
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
    """Raise RunDirError unless it is a folder of this user that nobody else can write to."""
    found = path.lstat()
    if not stat.S_ISDIR(found.st_mode):
        raise RunDirError(say("{path} is not a directory; remove it, or set DECK_RUN_DIR", path=path))
    if found.st_uid != os.getuid():
        raise RunDirError(say("{path} belongs to somebody else; set DECK_RUN_DIR to your own", path=path))
    if found.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
        raise RunDirError(
            say(
                "others can write to {path}; set DECK_RUN_DIR to a folder that only you "
                "can write to (a new one is created that way), or chmod go-w {path}",
                path=path,
            )
        )


def _not_made(path: Path, error: OSError) -> RunDirError:
    return RunDirError(say("{path} cannot be created: {reason}", path=path, reason=os_reason(error)))

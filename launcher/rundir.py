"""Where the launcher keeps what lives as long as a run, and the logs that outlive it.

The run directory holds control sockets: it must be the user's own, and closed to all others.
"""

from __future__ import annotations

import contextlib
import os
import stat
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.errors import RunDirError
from launcher.words import say

if TYPE_CHECKING:
    from collections.abc import Mapping

OWN_RUN_DIR = "DECK_RUN_DIR"
"""Environment variable that keeps the runs of one purpose apart from all others."""


def run_dir() -> Path:
    """Return the run directory, made if need be: mode 0700, the user's own.

    `DECK_RUN_DIR`, else `$XDG_RUNTIME_DIR/deck`, else `/tmp/deck-<uid>`.

    Raises:
        RunDirError: if it is a link, a file, or somebody else's.
    """
    return own_folder(run_path(os.environ))


def log_dir() -> Path:
    """Return the directory of the logs, made if need be.

    `DECK_LOG_DIR`, else `$XDG_STATE_HOME/deck/logs`, else `~/.local/state/deck/logs`.

    Raises:
        RunDirError: if it cannot be made or written.
    """
    chosen = os.environ.get("DECK_LOG_DIR")
    if chosen:
        path = Path(chosen)
    else:
        state = os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state"
        path = Path(state) / "deck" / "logs"
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _not_made(path, error) from error
    if not os.access(path, os.W_OK | os.X_OK):
        raise RunDirError(
            say("{path} cannot be written; set DECK_LOG_DIR to a folder of yours", path=path)
        )
    return path


def run_path(environ: Mapping[str, str]) -> Path:
    """Return where the run directory is by these variables, whether it is there or not."""
    chosen = environ.get(OWN_RUN_DIR)
    if chosen:
        return Path(chosen)
    runtime = Path(environ.get("XDG_RUNTIME_DIR") or "/nonexistent")
    if runtime.is_dir() and runtime.stat().st_uid == os.getuid():
        return runtime / "deck"
    return Path(f"/tmp/deck-{os.getuid()}")


def own_folder(path: Path) -> Path:
    """Make `path` if need be, and make sure that nobody else could have planted it.

    Raises:
        RunDirError: if it is a link, a file, or somebody else's, or cannot be made.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with contextlib.suppress(FileExistsError):
            path.mkdir(mode=0o700)
        found = path.lstat()
        if not stat.S_ISDIR(found.st_mode):
            raise RunDirError(
                say("{path} is not a directory; remove it, or set DECK_RUN_DIR", path=path)
            )
        if found.st_uid != os.getuid():
            raise RunDirError(
                say("{path} belongs to somebody else; set DECK_RUN_DIR to your own", path=path)
            )
        if stat.S_IMODE(found.st_mode) & 0o077:
            path.chmod(0o700)
    except OSError as error:
        raise _not_made(path, error) from error
    return path


def _not_made(path: Path, error: OSError) -> RunDirError:
    reason = error.strerror or str(error)
    return RunDirError(say("{path} cannot be made: {reason}", path=path, reason=reason))

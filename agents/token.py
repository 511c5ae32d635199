"""The token of `deck mcp --http`: made once, kept in a file that only its owner can read."""

from __future__ import annotations

import os
import secrets
import stat
from typing import TYPE_CHECKING

from platformdirs import user_config_path

from launcher.errors import UsageError
from launcher.private_files import make_folder, open_file
from text.os_words import os_reason
from text.sentences import say

if TYPE_CHECKING:
    from pathlib import Path

NAME = "mcp-token"
BYTES = 32
LONGEST = 200


def token_path() -> Path:
    """Return where the token is kept."""
    return user_config_path("deck") / NAME


def own_token() -> str:
    """Return the token, made if there is none yet.

    Raises:
        UsageError: if the file cannot be read or written, or is not private.
    """
    path = token_path()
    try:
        return _read(path)
    except FileNotFoundError:
        pass
    except OSError as error:
        raise _unusable(path, error) from error
    try:
        make_folder(path.parent)
        _make(path)
        return _read(path)
    except OSError as error:
        raise _unusable(path, error) from error


def _make(path: Path) -> None:
    try:
        descriptor = open_file(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL)
    except FileExistsError:
        return  # Another `deck mcp` has just made it.
    with os.fdopen(descriptor, "w", encoding="ascii") as file:
        file.write(secrets.token_urlsafe(BYTES) + "\n")


def _read(path: Path) -> str:
    descriptor = open_file(path, os.O_RDONLY)
    with os.fdopen(descriptor, encoding="ascii", errors="replace") as file:
        found = os.fstat(descriptor)
        if stat.S_IMODE(found.st_mode) & 0o077 or found.st_uid != os.geteuid():
            words = say("{path} can be read by others: remove it, and a new one is made", path=path)
            raise UsageError(words)
        token = file.read(LONGEST).strip()
    if len(token) < BYTES:
        raise UsageError(say("{path} holds no token: remove it, and a new one is made", path=path))
    return token


def _unusable(path: Path, error: OSError) -> UsageError:
    return UsageError(say("{path}: {reason}", path=path, reason=os_reason(error)))

"""Saving lines of a log to a file that the user names; it is not overwritten without asking."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterable
from datetime import datetime, timezone
from pathlib import Path

from text.i18n import N_, _, localized
from text.os_words import os_reason


def default_path(folder: str, time_s: float) -> Path:
    """Return a name for a new file in `folder`, from the local time `time_s`."""
    when = datetime.fromtimestamp(time_s, timezone.utc).astimezone()
    return Path(folder or ".") / f"deck-{when:%Y%m%d-%H%M%S}.log"


def home_path(name: str) -> Path:
    """Return the typed path, with `~` replaced by the home directory if there is one."""
    try:
        return Path(name).expanduser()
    except RuntimeError:
        return Path(name)


def save_lines(path: Path, lines: Iterable[str], *, replace: bool = False) -> int:
    """Write the lines, each with a line end, as UTF-8; return the number of bytes written.

    Creates missing folders. Raises FileExistsError unless `replace`, and any other OSError of the
    file system.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    flags = os.O_WRONLY | os.O_CREAT | (os.O_TRUNC if replace else os.O_EXCL)
    data = "".join(f"{line}\n" for line in lines).encode("utf-8", "replace")
    descriptor = os.open(path, flags, 0o644)
    with os.fdopen(descriptor, "wb") as file:
        file.write(data)
    return len(data)


_REASONS = {
    errno.EACCES: N_("not allowed to write there"),
    errno.EPERM: N_("not allowed to write there"),
    errno.EROFS: N_("that file system is read-only"),
    errno.EISDIR: N_("that is a folder: name a file in it"),
    errno.ENOTDIR: N_("a part of the path is a file, not a folder"),
    errno.ENOSPC: N_("the disk is full"),
    errno.ENAMETOOLONG: N_("the name is too long"),
}


def reason(error: OSError | ValueError) -> str:
    """Return why a file could not be written, in words."""
    if not isinstance(error, OSError):
        return str(error)
    known = _REASONS.get(error.errno or 0)
    return _(known) if known else localized(os_reason(error))

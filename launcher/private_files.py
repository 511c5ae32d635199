"""Files and folders that only their user can open, whatever the umask is.

What was there before is never changed.
"""

from __future__ import annotations

import contextlib
import os
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path


def make_folder(path: Path) -> None:
    """Make a folder, and those above it that are missing; one that is there is left as it is.

    Raises:
        OSError: if there is something else, or it cannot be made.
    """
    if path.is_dir():
        return
    for folder in reversed(path.parents):
        if not folder.is_dir():
            with contextlib.suppress(FileExistsError):
                folder.mkdir(mode=0o700)
    try:
        path.mkdir(mode=0o700)
    except FileExistsError:
        if not path.is_dir():  # Else somebody made it meanwhile.
            raise


def open_file(path: str | Path, flags: int, folder: int | None = None) -> int:
    """Return a descriptor of a file, made with mode 0600 if `flags` say so; no link is followed.

    `folder` is a descriptor of the folder that `path` is relative to.
    """
    return os.open(path, flags | os.O_CLOEXEC | os.O_NOFOLLOW, 0o600, dir_fd=folder)


def open_own_folder(path: Path) -> int:
    """Return a descriptor of a folder of this user's.

    Raises:
        OSError: if there is none, or a link, or it is somebody else's.
    """
    descriptor = os.open(path, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC | os.O_NOFOLLOW)
    if os.fstat(descriptor).st_uid != os.geteuid():
        os.close(descriptor)
        raise PermissionError(f"{path} belongs to somebody else")
    return descriptor


def remove_files(path: Path, folder: int, names: list[str]) -> None:
    """Remove these files from a folder, and the folder if nothing else is in it.

    `folder` is a descriptor of what is, or was, at `path`.
    """
    for name in names:
        with contextlib.suppress(OSError):
            os.unlink(name, dir_fd=folder)
    with contextlib.suppress(OSError):
        path.rmdir()

"""Files and folders that only their owner can open, whatever the umask is.

Existing files and folders are never changed.
"""

from __future__ import annotations

import contextlib
import os
from pathlib import Path


def make_folder(path: Path) -> None:
    """Make a folder and its missing parents; an existing folder is left as it is.

    Raises:
        OSError: if something else is there, or the folder cannot be made.
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
        if not path.is_dir():  # Otherwise somebody made it in the meantime.
            raise


def open_file(path: str | Path, flags: int, folder: int | None = None) -> int:
    """Return a descriptor of a file, created with mode 0600 if `flags` say so; follows no links.

    `folder`: a descriptor of the folder that `path` is relative to.
    """
    return os.open(path, flags | os.O_CLOEXEC | os.O_NOFOLLOW, 0o600, dir_fd=folder)


def open_own_folder(path: Path) -> int:
    """Return a descriptor of a folder that belongs to this user.

    Raises:
        OSError: if there is none, if it is a link, or if it belongs to another user.
    """
    descriptor = os.open(path, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC | os.O_NOFOLLOW)
    if os.fstat(descriptor).st_uid != os.geteuid():
        os.close(descriptor)
        raise PermissionError(f"{path} belongs to somebody else")
    return descriptor


def remove_files(path: Path, folder: int, names: list[str]) -> None:
    """Remove these files from a folder, then the folder if it is empty.

    `folder`: a descriptor of the folder that is, or was, at `path`.
    """
    for name in names:
        with contextlib.suppress(OSError):
            os.unlink(name, dir_fd=folder)
    with contextlib.suppress(OSError):
        path.rmdir()

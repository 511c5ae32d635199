"""A temporary folder of a viewer, of which nothing stays, however its process ends.

A process that is killed cannot remove its folder, so the next one does. A lock on the folder, which
the kernel opens when its holder ends, tells which are abandoned.
"""

from __future__ import annotations

import fcntl
import os
import shutil
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from typing_extensions import Self

PREFIX = "deck-view-"


class OwnFolder:
    """A new folder, until it is closed."""

    def __init__(self) -> None:
        """Remove what others have left, and make one."""
        _sweep()
        while True:
            self.path = Path(tempfile.mkdtemp(prefix=PREFIX))
            lock = _locked(self.path, fcntl.LOCK_EX)
            if lock is not None:
                self._lock = lock
                return

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        _remove(self.path, self._lock)


def _sweep() -> None:
    for path in Path(tempfile.gettempdir()).glob(f"{PREFIX}*"):
        lock = _locked(path, fcntl.LOCK_EX | fcntl.LOCK_NB)
        if lock is not None:
            _remove(path, lock)


def _locked(path: Path, how: int) -> int | None:
    """Return the descriptor that holds the lock of a folder; None if it is another's, or gone."""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC)
    except OSError:
        return None
    try:
        fcntl.flock(descriptor, how)
        # Somebody who swept may have had it between its making and its lock.
        if os.path.samestat(os.fstat(descriptor), path.lstat()):
            return descriptor
    except OSError:
        pass
    os.close(descriptor)
    return None


def _remove(path: Path, lock: int) -> None:
    shutil.rmtree(path, ignore_errors=True)
    os.close(lock)

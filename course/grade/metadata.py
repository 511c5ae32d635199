"""What a file or folder is beside its content: mode, owner, time of change, extended attributes."""

from __future__ import annotations

import os
import stat
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from typing_extensions import Self


@dataclass(frozen=True)
class Metadata:
    """That of one, never of what a link leads to."""

    mode: int
    uid: int
    gid: int
    changed_ns: int
    """0 for a folder: it changes with whatever is made in it."""
    attributes: tuple[tuple[str, bytes], ...]
    """Sorted by name; none where the file system has none."""

    @classmethod
    def read(cls, path: Path) -> Self:
        info = path.lstat()
        mode = stat.S_IMODE(info.st_mode)
        changed_ns = 0 if stat.S_ISDIR(info.st_mode) else info.st_mtime_ns
        return cls(mode, info.st_uid, info.st_gid, changed_ns, _attributes(path))

    def put_back(self, path: Path) -> bool:
        """Make it so again; return whether it was otherwise. Raises OSError if it cannot."""
        found = Metadata.read(path)
        if found == self:
            return False
        if stat.S_ISLNK(path.lstat().st_mode):
            return True
        if (found.uid, found.gid) != (self.uid, self.gid):
            os.chown(path, self.uid, self.gid, follow_symlinks=False)
        path.chmod(self.mode)
        for name, _value in found.attributes:
            os.removexattr(path, name, follow_symlinks=False)
        for name, value in self.attributes:
            os.setxattr(path, name, value, follow_symlinks=False)
        if self.changed_ns:
            os.utime(path, ns=(path.lstat().st_atime_ns, self.changed_ns), follow_symlinks=False)
        return True


def _attributes(path: Path) -> tuple[tuple[str, bytes], ...]:
    """Those of users; others belong to the system."""
    with suppress(OSError):
        names = sorted(os.listxattr(path, follow_symlinks=False))
        return tuple(
            (name, os.getxattr(path, name, follow_symlinks=False)) for name in names if name.startswith("user.")
        )
    return ()

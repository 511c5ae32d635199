"""A simulated serial device: a pseudo-terminal with a permanent name."""

from __future__ import annotations

import contextlib
import os
import pty
import tty
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

_MOST = 4096
_TERMINALS = "/dev/pts/"


class PseudoSerial:
    """One device; plugged in from the start. Reads and writes never wait."""

    def __init__(self, path: Path) -> None:
        """`path` becomes a symbolic link; raises OSError if it cannot, or is something else."""
        self.path = path
        self._ends: tuple[int, int] | None = None
        self.plug()

    def plug(self) -> None:
        if self._ends is not None:
            return
        ours, theirs = pty.openpty()
        tty.setraw(theirs)
        os.set_blocking(ours, False)
        # Keeping the other end open avoids an error whenever a program closes it.
        self._ends = ours, theirs
        fresh = self.path.with_name(f".{self.path.name}.{os.getpid()}")
        for path in (self.path, fresh):
            if not _is_free(path):
                self.unplug()
                raise FileExistsError(f"{path} is there already, and no device of ours")
        try:
            fresh.unlink(missing_ok=True)
            fresh.symlink_to(os.ttyname(theirs))
        except OSError:
            self.unplug()
            raise
        fresh.replace(self.path)

    def unplug(self) -> None:
        """Remove the device, as if the cable was pulled."""
        if self._ends is None:
            return
        ours, theirs = self._ends
        self._ends = None
        with contextlib.suppress(OSError):
            if self.path.is_symlink() and str(self.path.readlink()) == os.ttyname(theirs):
                self.path.unlink()
        os.close(theirs)
        os.close(ours)

    def read(self) -> bytes:
        """Return the bytes that have come, usually none."""
        if self._ends is None:
            return b""
        try:
            return os.read(self._ends[0], _MOST)
        except OSError:
            return b""

    def write(self, data: bytes) -> None:
        """Send; bytes that nobody reads for long are lost, as on a real wire."""
        if self._ends is not None and data:
            with contextlib.suppress(OSError):
                os.write(self._ends[0], data)


def _is_free(path: Path) -> bool:
    """Whether nothing has this name, or only the link of a pseudo-terminal."""
    try:
        return str(path.readlink()).startswith(_TERMINALS)
    except FileNotFoundError:
        return True
    except OSError:
        return False

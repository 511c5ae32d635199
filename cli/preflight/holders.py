"""Programs that have a device open, as far as /proc shows."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

PROC = Path("/proc")
MASTERS = ("/dev/ptmx", "/dev/pts/ptmx")


class Holder(NamedTuple):
    """A program that has the device open."""

    pid: int
    name: str

    def __str__(self) -> str:
        """Name it in the form in which a user would look for it."""
        return f"{self.name} (pid {self.pid})"


def holders(device: str, proc: Path = PROC) -> list[Holder]:
    """Return the other processes that have it open, by pid.

    The creator of a pseudo-terminal holds both of its ends and does not block it.
    """
    wanted = os.path.realpath(device)
    found = []
    for folder in proc.glob("[0-9]*"):
        pid = int(folder.name)
        if pid == os.getpid():
            continue
        files = _open_files(folder / "fd")
        if wanted in files and not (wanted.startswith("/dev/pts/") and files & set(MASTERS)):
            found.append(Holder(pid, _name(folder)))
    return sorted(found)


def _open_files(folder: Path) -> set[str]:
    try:
        return {path for descriptor in folder.iterdir() if (path := _target(descriptor))}
    except OSError:
        return set()  # A process of another user, or one that has ended.


def _target(descriptor: Path) -> str:
    try:
        return str(descriptor.readlink())
    except OSError:
        return ""  # Closed in the meantime.


def _name(folder: Path) -> str:
    """Return the name of the process; for a Python node, its title."""
    try:
        words = (folder / "cmdline").read_bytes().split(b"\0")
        name = os.path.basename(words[0].decode(errors="replace"))  # noqa: PTH119
        return name or (folder / "comm").read_text(errors="replace").strip()
    except OSError:
        return "?"

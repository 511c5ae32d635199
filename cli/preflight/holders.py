"""Which programs have a device open, as far as /proc shows."""

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
        """Name it as a person would look for it."""
        return f"{self.name} (pid {self.pid})"


def holders(device: str, proc: Path = PROC) -> list[Holder]:
    """Return who has it open, but for this process, by pid.

    Who made a pseudo-terminal keeps both of its ends and is none that stands in the way.
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
        return set()  # Somebody else's process, or it has ended.


def _target(descriptor: Path) -> str:
    try:
        return str(descriptor.readlink())
    except OSError:
        return ""  # Closed meanwhile.


def _name(folder: Path) -> str:
    """Return what the process is called; a Python node by its title."""
    try:
        words = (folder / "cmdline").read_bytes().split(b"\0")
        name = os.path.basename(words[0].decode(errors="replace"))  # noqa: PTH119
        return name or (folder / "comm").read_text(errors="replace").strip()
    except OSError:
        return "?"

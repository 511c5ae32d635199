"""/dev/shm, which nodes on one machine communicate through: free space, remains of dead nodes."""

from __future__ import annotations

import contextlib
import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from cli.doctor.finding import fail, ok, warn
from launcher.processes.shared_memory import SHARED_MEMORY, mapped_segments
from launcher.processes.shared_memory_unfinished import unfinished
from text.i18n import _, ngettext

if TYPE_CHECKING:
    from cli.doctor.finding import Finding

LEAST_FREE = 64 * 2**20
"""Least free bytes; Fast DDS takes half a megabyte for each node, and more for pictures."""
DELETE_MINE = "find /dev/shm -maxdepth 1 -user $(id -un) -name 'fastrtps_*' -delete"


@dataclass(frozen=True)
class SharedMemoryFacts:
    """The state of /dev/shm."""

    exists: bool = True
    free: int = 2**30
    """Bytes."""
    stale: int = 0
    """Fast DDS segments that belong to this user and that no process has mapped."""
    stale_bytes: int = 0
    unfinished: tuple[str, ...] = ()
    """Paths of files that make nodes hang, see `launcher.processes.shared_memory_unfinished`."""
    foreign: tuple[str, ...] = ()
    """Those of them that belong to another user."""


def collect() -> SharedMemoryFacts:
    if not SHARED_MEMORY.is_dir():
        return SharedMemoryFacts(exists=False, free=0)
    status = os.statvfs(SHARED_MEMORY)
    held = _mapped()
    stale = [
        path.stat().st_size
        for path in SHARED_MEMORY.glob("fastrtps_*")
        if not path.name.endswith(("_el", "_sl")) and path.name not in held and _is_mine(path)
    ]
    free = status.f_bavail * status.f_frsize
    halves = list(unfinished(SHARED_MEMORY))
    mine = tuple(str(path) for path in halves if _is_mine(path) or os.geteuid() == 0)
    foreign = tuple(str(path) for path in halves if str(path) not in mine)
    return SharedMemoryFacts(True, free, len(stale), sum(stale), mine, foreign)


def diagnose(facts: SharedMemoryFacts) -> list[Finding]:
    """Report what is all right and what is not."""
    if not facts.exists:
        text = _("there is no /dev/shm: nodes talk through the network stack, which is slower")
        return [warn("shm", text, _("mount it; in a container: --ipc=host"))]
    found = [_room(facts)]
    if facts.unfinished:
        text = _half_made(facts.unfinished)
        fix = _("Deck removes it at the next start; or: rm {paths}")
        paths = " ".join(facts.unfinished)
        found.append(warn("shm.unfinished", text, fix.format(paths=paths)))
    if facts.foreign:
        paths = " ".join(facts.foreign)
        found.append(fail("shm.foreign", _half_made(facts.foreign), f"sudo rm {paths}"))
    if facts.stale:
        words = ngettext(
            "{count} unused segment in /dev/shm ({size:.0f} MB)",
            "{count} unused segments in /dev/shm ({size:.0f} MB)",
            facts.stale,
        )
        text = words.format(count=facts.stale, size=facts.stale_bytes / 1e6)
        # Selecting by name alone would include files of other users.
        fix = _("while none of your ROS nodes is running: {command}").format(command=DELETE_MINE)
        found.append(warn("shm.stale", text, fix))
    return found


def _half_made(paths: tuple[str, ...]) -> str:
    text = _("{paths}: incomplete, left by a process that was killed; any node that opens it hangs")
    return text.format(paths=", ".join(paths))


def _room(facts: SharedMemoryFacts) -> Finding:
    text = _("/dev/shm has {size:.0f} MB free").format(size=facts.free / 1e6)
    if facts.free < LEAST_FREE:
        fix = _("free some space, or enlarge it; in a container: --shm-size=256m")
        return warn("shm", text, fix)
    return ok("shm", text)


def _mapped() -> set[str]:
    """Return the names of those that processes have mapped, as far as they may be inspected."""
    held: set[str] = set()
    for folder in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            held |= mapped_segments(int(folder.name))
    return held


def _is_mine(path: Path) -> bool:
    try:
        return path.stat().st_uid == os.getuid()
    except OSError:
        return False

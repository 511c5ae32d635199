"""Shared memory files whose creator was killed while creating them.

Each Fast DDS file begins with a word in which boost.interprocess keeps the state of its creation. A
process that opens a file under creation waits until it is complete, and for ever if its creator is
dead: one such file blocks every node on the machine that comes across it. Seen with Fast DDS 2.14:
nodes hung for minutes because a killed one had begun /dev/shm/fastrtps_port7002.
"""

from __future__ import annotations

import fcntl
import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.processes.shared_memory import NAME, SHARED_MEMORY, STATES, age_s, is_users_alone, names

if TYPE_CHECKING:
    from collections.abc import Iterator

_FILE = re.compile(NAME)
UNFINISHED_S = 3.0
"""Age from which an incomplete file has lost its creator: creating one takes milliseconds."""
_BEING_MADE = STATES[:3]
_CORRUPTED = STATES[4]
"""A process that waits for this file gives up and creates a new one."""


@dataclass(frozen=True)
class Discarded:
    """What was done with the incomplete files."""

    removed: tuple[str, ...]
    """Names of files."""
    kept: tuple[str, ...]
    """Files that belong to another user, or have other hard links."""


def unfinished(folder: Path = SHARED_MEMORY) -> Iterator[Path]:
    """Yield the files whose creators were killed while creating them."""
    for name in filter(_FILE.fullmatch, names(folder)):
        path = folder / name
        if _begins(path) in _BEING_MADE and age_s(path) > UNFINISHED_S:
            yield path


def discard_unfinished(folder: Path = SHARED_MEMORY) -> Discarded:
    """Remove the files that nobody will complete, and release the processes waiting for one."""
    removed, kept = list[str](), list[str]()
    for path in unfinished(folder):
        (removed if _discard(path) else kept).append(path.name)
    return Discarded(tuple(removed), tuple(kept))


def _discard(path: Path) -> bool:
    """Remove a file, or notice that another Deck did; return False if it is another user's."""
    try:
        descriptor = os.open(path, os.O_RDWR | os.O_CLOEXEC | os.O_NOFOLLOW)
    except OSError as problem:
        return not isinstance(problem, PermissionError)
    try:
        if not is_users_alone(descriptor):
            return False
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        if os.path.samestat(os.fstat(descriptor), path.lstat()):
            # This comes first: a released process immediately creates a new file of this name.
            path.unlink()
            os.pwrite(descriptor, _CORRUPTED, 0)
    except PermissionError:
        return False
    except OSError:
        return True
    finally:
        os.close(descriptor)
    return True


def _begins(path: Path) -> bytes | None:
    """Return the first word of a file, less if it is shorter; None if it cannot be read."""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_CLOEXEC | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        return None
    try:
        return os.read(descriptor, len(_CORRUPTED))
    except OSError:
        return None
    finally:
        os.close(descriptor)

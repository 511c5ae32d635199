"""Shared memory that Fast DDS nodes leave behind when they are killed.

A participant holds a segment `/dev/shm/fastrtps_<16 hex digits>`, half a megabyte, and ports that
it listens on, `/dev/shm/fastrtps_port<number>`, with an exclusive flock(2) on the file beside each,
`..._el`, for as long as it lives. A node that ends as it should removes all; of one that was killed
the locks go and the files stay.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import re
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

SHARED_MEMORY = Path("/dev/shm")
_LOCK = re.compile(r"(fastrtps_(?:[0-9a-f]{16}|port\d+))_el")
_PORT = "fastrtps_port"


def held_segments(pid: int) -> set[str]:
    """Return the names of the segments and ports that a process holds."""
    found = set()
    folder = f"/proc/{pid}/fd"
    with contextlib.suppress(OSError):
        for descriptor in os.listdir(folder):  # noqa: PTH208
            with contextlib.suppress(OSError):
                target = Path(os.readlink(f"{folder}/{descriptor}"))  # noqa: PTH115
                match = _LOCK.fullmatch(target.name)
                if match is not None and target.parent == SHARED_MEMORY:
                    found.add(match[1])
    return found


def port_numbers(names: Iterable[str]) -> list[int]:
    """Return the numbers of those that are ports."""
    return sorted(int(name.removeprefix(_PORT)) for name in names if name.startswith(_PORT))


def sweep(segments: Iterable[str], folder: Path = SHARED_MEMORY) -> list[str]:
    """Remove those of these segments that nobody holds any more; return their names."""
    return [name for name in segments if _remove(folder / name)]


def _remove(segment: Path) -> bool:
    lock = segment.with_name(f"{segment.name}_el")
    try:
        descriptor = os.open(lock, os.O_RDONLY | os.O_CLOEXEC | os.O_NOFOLLOW)
    except OSError:
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        segment.unlink(missing_ok=True)
        lock.unlink(missing_ok=True)
    except OSError:
        return False
    finally:
        os.close(descriptor)
    return True

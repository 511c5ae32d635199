"""Messages in shared memory that a process had in hand when it was killed.

Who listens at a port of Fast DDS marks there that it has a message in hand. When it is killed
meanwhile, the mark stays, and a sender that finds the port broken and its listener dead takes each
mark away first. In Fast DDS 2.14 it cannot: it holds the lock of the port, waits 1 s for the same
lock, and tries again, for ever. In rclpy that is with Python's lock held: a screen of Deck stood
still, keys included, after the supervisor and its nodes had been killed while they were meeting it.

Here the marks of the dead are taken away, which also ends the loop of a sender that is in it.

The layout is that of `PortNode` in Fast DDS's SharedMemGlobal.hpp, ABI 5: the slots of the
listeners, the name of the domain, and then the name under which boost.interprocess finds it all.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

from launcher.processes.shared_memory import SHARED_MEMORY, is_users_alone, names

_PORT = re.compile(r"fastrtps_port\d+")
_LOCKS = ("_el", "_sl")
"""What follows the name of a port in those of the files that its listeners have locked."""
_LOCK = re.compile(r"\d+: FLOCK .* ([0-9a-f]+):([0-9a-f]+):(\d+) \S+ \S+")
_NAME = b"port_node_abi5\0"
_DOMAIN = b"fastrtps\0".ljust(24, b"\0")
_MOST_BYTES = 1 << 16
"""What is looked for is at the beginning; the queue of messages comes after it."""
_SLOTS = 1024
_SLOT_BYTES = 20
_IN_USE, _IN_HAND = 0x01, 0x04
"""Bits of the first byte of a slot."""


def release_in_hand(folder: Path = SHARED_MEMORY) -> list[str]:
    """Take away the marks of dead processes; return the names of their ports."""
    there = set(names(folder))
    try:
        locked = _locked_files()
    except OSError:
        return []
    return [
        name
        for name in filter(_PORT.fullmatch, sorted(there))
        if not any(
            name + lock in there and _is_one_of(folder / f"{name}{lock}", locked) for lock in _LOCKS
        )
        and _release(folder / name)
    ]


def _locked_files() -> set[tuple[int, int]]:
    """Return device and inode of every file with a lock by flock(2).

    To try the lock of a port would hinder a process that takes it at the same moment.
    """
    matches = map(_LOCK.match, Path("/proc/locks").read_text("ascii").splitlines())
    return {
        (os.makedev(int(match[1], 16), int(match[2], 16)), int(match[3]))
        for match in matches
        if match is not None
    }


def _is_one_of(path: Path, files: set[tuple[int, int]]) -> bool:
    try:
        found = path.lstat()
    except OSError:
        return False
    return (found.st_dev, found.st_ino) in files


def _release(port: Path) -> bool:
    """Take away the marks in a port, unless it is another user's; return whether there were any."""
    try:
        descriptor = os.open(port, os.O_RDWR | os.O_CLOEXEC | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        return False
    try:
        if not is_users_alone(descriptor):
            return False
        marked = _marked(os.pread(descriptor, _MOST_BYTES, 0))
        for place, slot in marked:
            os.pwrite(descriptor, bytes([slot & ~_IN_HAND]), place)
    except OSError:
        return False
    finally:
        os.close(descriptor)
    return bool(marked)


def _marked(memory: bytes) -> list[tuple[int, int]]:
    """Return place and content of the slots with a mark; none in a file of another layout."""
    end = memory.find(_DOMAIN + _NAME)
    first = end - _SLOTS * _SLOT_BYTES
    if first < 0:
        return []
    # Those that were never used are behind the others.
    slots = memory[first:end:_SLOT_BYTES].rstrip(b"\0")
    wanted = _IN_USE | _IN_HAND
    return [
        (first + number * _SLOT_BYTES, slot)
        for number, slot in enumerate(slots)
        if slot & wanted == wanted
    ]

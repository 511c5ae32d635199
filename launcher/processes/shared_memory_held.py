"""What a process held in the shared memory of Fast DDS when it was killed: locks and messages.

A port has two locks, which a sender and its listener take for microseconds each. They know nothing
of the death of who holds them: everybody else waits 1 s, then takes the port for broken and makes
it anew. In Fast DDS 2.14 a node that ends at that moment locks what is unmapped meanwhile, and dies
by SIGSEGV (1 in 70 ends beside a node that was killed while it sent 500 times a second).

Who listens at a port also marks there that it has a message in hand. When it is killed meanwhile,
the mark stays, and a sender that finds the port broken and its listener dead takes each mark away
first. Fast DDS 2.14 cannot: it holds a lock of the port, waits 1 s for the same lock, and tries
again, for ever. In rclpy that is with Python's lock held: a screen of Deck stood still, keys
included, after the supervisor and its nodes had been killed while they were meeting it.

Here locks are opened and marks taken away for the dead, which also ends the loop of a sender that
is in it.

The layout is that of `PortNode` in Fast DDS's SharedMemGlobal.hpp, ABI 5: the lock of the waiting
listeners, the lock of the port, the slots of the listeners, the name of the domain, and then the
name under which boost.interprocess finds it all.
"""

from __future__ import annotations

import contextlib
import ctypes
import fcntl
import mmap
import os
import platform
import re
import struct
import time
from pathlib import Path

from launcher.processes.shared_memory import SHARED_MEMORY, is_users_alone, names
from launcher.processes.table import read_process

_PORT = re.compile(r"fastrtps_port\d+")
_LOCK_OF_PORT = re.compile(rf"({_PORT.pattern})_[es]l")
"""The names of the files that listeners have locked, for one alone or for several."""
_LOCK = re.compile(r"\d+: FLOCK .* ([0-9a-f]+):([0-9a-f]+):(\d+) \S+ \S+")
_NAME = b"port_node_abi5\0"
_DOMAIN = b"fastrtps\0".ljust(24, b"\0")
_MOST_BYTES = 1 << 16
"""What is looked for is at the beginning; the queue of messages comes after it."""
_SLOTS = 1024
_SLOT_BYTES = 20
_IN_USE, _IN_HAND = 0x01, 0x04
"""Bits of the first byte of a slot."""
_MUTEX_BYTES = {"x86_64": 40, "aarch64": 48}
"""Size of a pthread_mutex_t of glibc."""
_MUTEX = struct.Struct("<iIiIi")
"""Its first words: state (0 is free), count, thread that holds it, users, and kind."""
_SHARED = 128
"""The kind that works between processes, and is not robust."""
_CERTAIN_S = 0.02
"""A lock that the living hold as long as this is one in a namespace of processes of its own."""


def release_held(folder: Path = SHARED_MEMORY) -> list[str]:
    """Release what dead processes hold; return the names of those ports."""
    try:
        listened_at = _listened_at(folder)
    except OSError:
        return []
    return [
        name
        for name in sorted(filter(_PORT.fullmatch, names(folder)))
        if _release(folder / name, is_listened_at=name in listened_at)
    ]


def release_locks(folder: Path = SHARED_MEMORY) -> list[str]:
    """Open what the dead have locked of ports that somebody listens at: this cannot wait.

    Ports of the dead, of which there may be hundreds, are not looked at.
    """
    try:
        listened_at = _listened_at(folder)
    except OSError:
        return []
    return [name for name in sorted(listened_at) if _release(folder / name, is_listened_at=True)]


def _listened_at(folder: Path) -> set[str]:
    """Return the names of the ports that a living process listens at; raises `OSError`."""
    locked, device = _locked_files(), folder.stat().st_dev
    with os.scandir(folder) as entries:
        return {
            match[1]
            for entry in entries
            if (match := _LOCK_OF_PORT.fullmatch(entry.name)) is not None and (device, entry.inode()) in locked
        }


def _locked_files() -> set[tuple[int, int]]:
    """Return device and inode of every file with a lock by flock(2).

    To try the lock of a port would hinder a process that takes it at the same moment.
    """
    matches = map(_LOCK.match, Path("/proc/locks").read_text("ascii").splitlines())
    return {
        (os.makedev(int(match[1], 16), int(match[2], 16)), int(match[3])) for match in matches if match is not None
    }


def _release(port: Path, *, is_listened_at: bool) -> bool:
    """Release what the dead hold in a port, unless it is another user's; return whether any did."""
    try:
        descriptor = os.open(port, os.O_RDWR | os.O_CLOEXEC | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        return False
    try:
        if not is_users_alone(descriptor):
            return False
        memory = os.pread(descriptor, _MOST_BYTES, 0)
        first = memory.find(_DOMAIN + _NAME, _SLOTS * _SLOT_BYTES) - _SLOTS * _SLOT_BYTES
        if first < 0:
            return False
        marked = [] if is_listened_at else _marked(memory, first)
        for place, slot in marked:
            os.pwrite(descriptor, bytes([slot & ~_IN_HAND]), place)
        dead = _dead_locks(memory, first)
        if dead:
            _unlock(descriptor, first, dead)
    except OSError:
        return False
    finally:
        os.close(descriptor)
    return bool(marked or dead)


def _marked(memory: bytes, first: int) -> list[tuple[int, int]]:
    """Return place and content of the slots with a mark."""
    # Those that were never used are behind the others.
    slots = memory[first : first + _SLOTS * _SLOT_BYTES : _SLOT_BYTES].rstrip(b"\0")
    wanted = _IN_USE | _IN_HAND
    return [(first + number * _SLOT_BYTES, slot) for number, slot in enumerate(slots) if slot & wanted == wanted]


def _dead_locks(memory: bytes | mmap.mmap, first: int) -> dict[int, int]:
    """Return the places of the locks that the dead hold, and who; {} where they differ."""
    size = _MUTEX_BYTES.get(platform.machine(), 0)
    found = {}
    for place in range(first - 2 * size, first, size) if 0 < 2 * size <= first else ():
        state, _count, holder, _users, kind = _MUTEX.unpack_from(memory, place)
        if kind == _SHARED and state and holder > 0 and _is_dead(holder):
            found[place] = holder
    return found


def _is_dead(thread: int) -> bool:
    """Whether no thread of this number is alive, whoever's it is."""
    try:
        # Unlike /proc, which may hide those of others, this finds every thread.
        os.kill(thread, 0)
    except ProcessLookupError:
        return True
    except OSError:
        return False
    process = read_process(thread)
    return process is not None and process.zombie


def _unlock(descriptor: int, first: int, dead: dict[int, int]) -> None:
    """Open the locks of a port that these dead still hold."""
    # A lock that two open one after the other may be somebody's in between.
    fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    time.sleep(_CERTAIN_S)
    with contextlib.closing(mmap.mmap(descriptor, 0)) as memory:
        for place, holder in _dead_locks(memory, first).items():
            if dead.get(place) == holder:
                lock = ctypes.c_char.from_buffer(memory, place)
                # Locks of this kind do not ask who opens them, and wake who waits.
                ctypes.CDLL(None).pthread_mutex_unlock(ctypes.byref(lock))
                del lock

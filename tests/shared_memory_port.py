"""A port of Fast DDS in shared memory, brought into the state in which a killed process leaves it.

Offsets are those of `PortNode` and `ListenerStatus` in Fast DDS's SharedMemGlobal.hpp, ABI 5.
"""

from __future__ import annotations

import ctypes
import mmap
import os
import platform
import struct
from pathlib import Path

from launcher.processes.shared_memory import SHARED_MEMORY, held_segments, port_numbers

DOMAIN_AND_NAME = b"fastrtps\0".ljust(24, b"\0") + b"port_node_abi5\0"
SLOTS_BYTES = 1024 * 20
MUTEX_BYTES = {"x86_64": 40, "aarch64": 48}
"""Size of a pthread_mutex_t."""
IN_HAND = 0x04
OK = 0x01


class SharedMemoryPort:
    """One port, mapped; what it had stays to be seen after its file has been removed."""

    def __init__(self, number: int) -> None:
        """Map the port of this number, which one process listens at."""
        self._path = SHARED_MEMORY / f"fastrtps_port{number}"
        with self._path.open("r+b") as file:
            self._memory = mmap.mmap(file.fileno(), 0)
            self._inode = os.fstat(file.fileno()).st_ino
        self._address = ctypes.addressof(ctypes.c_char.from_buffer(self._memory))
        self._slot = self._memory.find(DOMAIN_AND_NAME) - SLOTS_BYTES
        self._mutex = self._slot - MUTEX_BYTES[platform.machine()]
        # Number, listeners, and two time-outs in ms; two more words come before the flags.
        self._flags = self._memory.find(struct.pack("<4I", number, 1, 1000, 333)) + 24

    @property
    def in_hand(self) -> bool:
        """Whether its listener is marked as having a message in hand.

        Not once a process of any domain has taken the number: then nobody waits for the listener.
        """
        return bool(self._memory[self._slot] & IN_HAND) and not self._is_replaced()

    def take_in_hand(self) -> None:
        self._memory[self._slot] |= IN_HAND

    def break_down(self) -> None:
        """Mark the port as one that no longer works, as whoever watches over it does."""
        self._memory[self._flags] &= ~OK

    def lock(self) -> None:
        """Take its lock, as whoever sends or listens does for a moment."""
        assert ctypes.CDLL(None).pthread_mutex_lock(ctypes.c_void_p(self._address + self._mutex)) == 0

    def unlock(self) -> None:
        ctypes.CDLL(None).pthread_mutex_unlock(ctypes.c_void_p(self._address + self._mutex))

    @property
    def is_locked(self) -> bool:
        """Whether somebody holds it, alive or dead."""
        lock = ctypes.c_void_p(self._address + self._mutex)
        held: bool = ctypes.CDLL(None).pthread_mutex_trylock(lock) != 0
        if not held:
            self.unlock()
        return held

    def is_open_in(self, pid: int) -> bool:
        """Whether this process has met the one that listens here, and sends to it."""
        return bool(self._places_in(pid))

    def is_awaited_by(self, pid: int) -> bool:
        """Whether a thread of this process waits for the lock."""
        locks = {place + self._mutex for place in self._places_in(pid)}
        calls = (task / "syscall" for task in Path(f"/proc/{pid}/task").iterdir())
        words = (call.read_text().split() for call in calls)
        return any(len(word) > 1 and int(word[1], 16) in locks for word in words)

    def _is_replaced(self) -> bool:
        try:
            return self._path.stat().st_ino != self._inode
        except FileNotFoundError:
            return False

    def _places_in(self, pid: int) -> list[int]:
        """Return the addresses at which this process has mapped it."""
        lines = map(str.split, Path(f"/proc/{pid}/maps").read_text().splitlines())
        return [int(line[0].split("-")[0], 16) for line in lines if line[4] == str(self._inode)]


def ports_of(pid: int) -> list[SharedMemoryPort]:
    return [SharedMemoryPort(number) for number in port_numbers(held_segments(pid))]

"""A lock and the mark of a message in hand are taken from the dead, and from nobody else."""

from __future__ import annotations

import ctypes
import fcntl
import mmap
import platform
import subprocess
import sys
from pathlib import Path

import pytest

from launcher.processes.shared_memory_held import release_held, release_locks
from tests.shared_memory_port import DOMAIN_AND_NAME, MUTEX_BYTES
from tests.unit.launcher.processes.test_shm import made
from tests.waiting import wait_until

PORT = "fastrtps_port7411"
BEFORE = bytes(20_000)
IN_USE, WAITING, IN_HAND = 1, 2, 4


def port_of(*slots: int) -> bytes:
    """A port whose first listeners are in these states."""
    each = b"".join(bytes([slot]).ljust(20, b"\7") for slot in slots)
    return BEFORE + each.ljust(1024 * 20, b"\0") + DOMAIN_AND_NAME + bytes(10_000)


def test_marks_of_the_dead_are_taken_away_and_all_else_stays(tmp_path: Path) -> None:
    path = made(tmp_path / PORT, port_of(IN_USE | IN_HAND, IN_HAND, IN_USE, IN_USE | 2 | IN_HAND))
    made(tmp_path / f"{PORT}_el", b"")
    assert release_held(tmp_path) == [PORT]
    assert path.read_bytes() == port_of(IN_USE, IN_HAND, IN_USE, IN_USE | WAITING)
    assert release_held(tmp_path) == []


@pytest.mark.parametrize("suffix", ["_el", "_sl"])
def test_the_living_keep_theirs(tmp_path: Path, suffix: str) -> None:
    path = made(tmp_path / PORT, port_of(IN_USE | IN_HAND))
    with made(tmp_path / f"{PORT}{suffix}", b"").open() as lock:
        fcntl.flock(lock, fcntl.LOCK_EX if suffix == "_el" else fcntl.LOCK_SH)
        assert release_held(tmp_path) == []
    assert path.read_bytes() == port_of(IN_USE | IN_HAND)
    assert release_held(tmp_path) == [PORT]


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\2",
        port_of(IN_USE | IN_HAND)[20_001:],
        port_of(IN_USE | IN_HAND).replace(b"abi5", b"abi6"),
    ],
)
def test_what_is_laid_out_otherwise_is_left_alone(tmp_path: Path, content: bytes) -> None:
    path = made(tmp_path / PORT, content)
    assert release_held(tmp_path) == []
    assert path.read_bytes() == content


def test_only_ports_are_looked_at(tmp_path: Path) -> None:
    held = port_of(IN_USE | IN_HAND)
    precious = made(tmp_path / "precious", held)
    (tmp_path / PORT).symlink_to(precious)
    made(tmp_path / "fastrtps_0123456789abcdef", held)
    (tmp_path / "fastrtps_port7413").mkdir()
    (tmp_path / "fastrtps_port7415").hardlink_to(precious)
    assert release_held(tmp_path) == []
    assert release_held(tmp_path / "missing") == []
    assert precious.read_bytes() == held


SIZE = MUTEX_BYTES[platform.machine()]
LOCKS = [len(BEFORE) - SIZE, len(BEFORE) - 2 * SIZE]
"""Where the lock of a port and that of its waiting listeners are."""
HOLDER = """
import ctypes, mmap, os, sys
path, place, shared = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
with open(path, "r+b") as file:
    memory = mmap.mmap(file.fileno(), 0)
lock = ctypes.byref(ctypes.c_char.from_buffer(memory, place))
kind = ctypes.byref(ctypes.create_string_buffer(64))
c = ctypes.CDLL(None)
c.pthread_mutexattr_init(kind)
c.pthread_mutexattr_setpshared(kind, shared)
c.pthread_mutex_init(lock, kind)
c.pthread_mutex_lock(lock)
print("held", flush=True)
sys.stdin.read()
os._exit(0)
"""


def held_lock(path: Path, place: int, shared: int = 1) -> subprocess.Popen[str]:
    """Return a process that holds a lock of the port."""
    argv = [sys.executable, "-c", HOLDER, str(path), str(place), str(shared)]
    holder = subprocess.Popen(argv, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert holder.stdout is not None
    assert holder.stdout.readline() == "held\n"
    return holder


def is_held(path: Path, place: int) -> bool:
    with path.open("r+b") as file, mmap.mmap(file.fileno(), 0) as memory:
        there = ctypes.c_char.from_buffer(memory, place)
        held: bool = ctypes.CDLL(None).pthread_mutex_trylock(ctypes.byref(there)) != 0
        if not held:
            ctypes.CDLL(None).pthread_mutex_unlock(ctypes.byref(there))
        del there
    return held


@pytest.mark.parametrize("place", LOCKS)
def test_a_lock_is_opened_once_its_holder_is_dead(tmp_path: Path, place: int) -> None:
    path = made(tmp_path / PORT, port_of(IN_USE))
    with held_lock(path, place) as holder:
        assert release_held(tmp_path) == []
        assert is_held(path, place)
        holder.kill()
    assert is_held(path, place)
    assert release_held(tmp_path) == [PORT]
    assert not is_held(path, place)
    assert release_held(tmp_path) == []


def test_the_holder_may_be_dead_and_not_yet_waited_for(tmp_path: Path) -> None:
    path = made(tmp_path / PORT, port_of(IN_USE))
    with held_lock(path, LOCKS[0]) as holder:
        assert holder.stdin is not None
        holder.kill()
        wait_until(lambda: release_held(tmp_path) == [PORT], "a lock that is opened")
        assert not is_held(path, LOCKS[0])


def test_a_lock_of_the_living_port_is_opened_and_its_messages_stay(tmp_path: Path) -> None:
    path = made(tmp_path / PORT, port_of(IN_USE | IN_HAND))
    with held_lock(path, LOCKS[0]) as holder:
        holder.kill()
    with made(tmp_path / f"{PORT}_el", b"").open() as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        assert release_locks(tmp_path) == [PORT]
        assert release_held(tmp_path) == []
    assert path.read_bytes()[len(BEFORE)] == IN_USE | IN_HAND
    assert not is_held(path, LOCKS[0])


def test_what_cannot_wait_are_locks_of_the_living(tmp_path: Path) -> None:
    path = made(tmp_path / PORT, port_of(IN_USE))
    with held_lock(path, LOCKS[0]) as holder:
        holder.kill()
    assert release_locks(tmp_path) == []
    assert release_locks(tmp_path / "missing") == []
    assert is_held(path, LOCKS[0])


def test_what_two_see_at_once_one_opens(tmp_path: Path) -> None:
    path = made(tmp_path / PORT, port_of(IN_USE))
    with held_lock(path, LOCKS[0]) as holder:
        holder.kill()
    with path.open() as other:
        fcntl.flock(other, fcntl.LOCK_EX)
        assert release_held(tmp_path) == []
    assert is_held(path, LOCKS[0])
    assert release_held(tmp_path) == [PORT]


def test_a_lock_within_one_process_is_left_alone(tmp_path: Path) -> None:
    path = made(tmp_path / PORT, port_of(IN_USE))
    with held_lock(path, LOCKS[0], shared=0) as holder:
        holder.kill()
    assert release_held(tmp_path) == []

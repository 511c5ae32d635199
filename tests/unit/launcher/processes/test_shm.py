"""Shared memory that the dead have left: removed if nobody holds it, and nothing else."""

from __future__ import annotations

import ctypes
import fcntl
import mmap
import os
import platform
import subprocess
import sys
from pathlib import Path

import pytest

from launcher.processes.shared_memory import sweep
from launcher.processes.shared_memory_held import release_held, release_locks
from launcher.processes.shared_memory_unfinished import UNFINISHED_S, Discarded, discard_unfinished, unfinished
from tests.shared_memory_port import DOMAIN_AND_NAME, MUTEX_BYTES
from tests.unfinished_shared_memory import make_old

SEGMENT = b"\2" + bytes(4095)
"""As boost.interprocess leaves one that it has finished."""
DEAD, ALIVE, GONE = "fastrtps_00000000000000d0", "fastrtps_00000000000000a1", "fastrtps_0"


def test_only_what_nobody_holds_is_removed(tmp_path: Path) -> None:
    for name in (DEAD, ALIVE):
        (tmp_path / name).write_bytes(SEGMENT)
        (tmp_path / f"{name}_el").touch()
    with (tmp_path / f"{ALIVE}_el").open() as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        assert sweep([DEAD, ALIVE, GONE], tmp_path) == [DEAD]
    assert sorted(path.name for path in tmp_path.iterdir()) == [ALIVE, f"{ALIVE}_el"]


def test_what_is_not_of_fast_dds_or_not_the_users_own_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By name, content and owner: somebody may have given a file of his such a name."""
    text, lock, linked = (f"fastrtps_{number:016x}" for number in (1, 2, 3))
    for name in (text, lock, linked):
        (tmp_path / name).write_bytes(SEGMENT)
        (tmp_path / f"{name}_el").touch()
    (tmp_path / text).write_text("precious")
    (tmp_path / f"{lock}_el").write_text("precious")
    (tmp_path / "precious").hardlink_to(tmp_path / linked)
    before = sorted(tmp_path.iterdir())
    assert sweep([text, lock, linked], tmp_path) == []
    (tmp_path / "precious").unlink()
    with monkeypatch.context() as patch:
        patch.setattr(os, "geteuid", lambda: 4_000_000)
        assert sweep([linked], tmp_path) == []
    assert sorted(tmp_path.iterdir()) == [path for path in before if path.name != "precious"]
    assert sweep([linked], tmp_path) == [linked]


def made(path: Path, content: bytes, age_s: float = 60.0) -> Path:
    """A file that was written so long ago."""
    path.write_bytes(content)
    make_old([path], age_s)
    return path


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


@pytest.mark.parametrize("begun", [b"", bytes(4096), b"\1" + bytes(4095)])
def test_what_nobody_will_finish_is_removed_and_who_waits_is_let_go(tmp_path: Path, begun: bytes) -> None:
    path = made(tmp_path / "fastrtps_port7001", begun)
    with path.open("rb") as waiting:
        assert discard_unfinished(tmp_path) == Discarded(("fastrtps_port7001",), ())
        assert waiting.read(4) == b"\3\0\0\0"
    assert not path.exists()


def test_what_is_finished_or_just_being_made_stays(tmp_path: Path) -> None:
    made(tmp_path / DEAD, b"\2" + bytes(4095))
    made(tmp_path / f"{DEAD}_el", b"")
    made(tmp_path / "fastrtps_port7001", b"\1" + bytes(4095), age_s=UNFINISHED_S / 2)
    made(tmp_path / "somebody_elses", b"")
    (tmp_path / "fastrtps_port7002").symlink_to(made(tmp_path / "precious", b""))
    (tmp_path / "fastrtps_port7003").mkdir()
    before = sorted(tmp_path.iterdir())
    assert discard_unfinished(tmp_path) == Discarded((), ())
    assert sorted(tmp_path.iterdir()) == before


@pytest.fixture
def of_another_user(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A file that may be read, and no more."""
    really = os.open

    def refuse(file: str, flags: int) -> int:
        if flags & os.O_RDWR:
            raise PermissionError
        return really(file, flags)

    monkeypatch.setattr(os, "open", refuse)
    return made(tmp_path / "fastrtps_port7002", b"")


def test_what_belongs_to_another_user_stays(tmp_path: Path, of_another_user: Path) -> None:
    assert list(unfinished(tmp_path)) == [of_another_user]
    assert discard_unfinished(tmp_path) == Discarded((), ("fastrtps_port7002",))
    assert of_another_user.exists()

"""A confined process reaches no further than it may, and neither do its children.

All that it tries to harm is the test's own.
"""

from __future__ import annotations

import ctypes
import json
import os
import socket
import stat
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import pytest

from launcher.processes.confinement import Confinement, confinement

TRIES = """
import ctypes, fcntl, json, os, resource, shutil, socket, struct, subprocess, sys, termios
import threading
from launcher.processes.confinement import confine

own, other, victim, terminal, port, memory = sys.argv[1:]
confine([own])
libc = ctypes.CDLL(None, use_errno=True)
there = f"{other}/there"
victim = int(victim)

def told(act):
    try:
        act()
    except (OSError, ValueError) as error:
        return f"refused: {type(error).__name__}"
    return "done"

def call(number, *arguments):
    if libc.syscall(number, *arguments) != 0:
        raise OSError(ctypes.get_errno(), "refused")

def attach(number):
    libc.shmat.restype = ctypes.c_void_p
    if libc.shmat(number, None, 0) == ctypes.c_void_p(-1).value:
        raise OSError(ctypes.get_errno(), "refused")

def write(path):
    open(path, "w").close()

def connect():
    with socket.socket(socket.AF_UNIX) as client:
        client.connect(f"{other}/socket")

def datagram():
    for one in socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM):
        one.sendto(b"x", f"{other}/datagrams")

def fast_open():
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as client:
        client.sendto(b"x", socket.MSG_FASTOPEN, ("127.0.0.1", int(port)))

def multipath():
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM, 262) as client:
        client.connect(("127.0.0.1", int(port)))

def signal_by_file(number, owner):
    # The kernel sends it when something comes.
    ours, theirs = socket.socketpair()
    owner(ours.fileno())
    fcntl.fcntl(ours, 10, number)
    fcntl.fcntl(ours, fcntl.F_SETFL, os.O_ASYNC | os.O_NONBLOCK)
    theirs.send(b"x")

def typed():
    fcntl.ioctl(os.open(terminal, os.O_RDONLY | os.O_NOCTTY), termios.TIOCSTI, b"x")

child = "import os; os.kill(os.getppid(), 0); open(%r, 'w')" % f"{other}/child"
print(json.dumps({
    "write": told(lambda: write(f"{own}/new")),
    "rename": told(lambda: os.rename(f"{own}/new", f"{own}/newer")),
    "copy": told(lambda: shutil.copy2(f"{own}/newer", f"{own}/copy")),
    "null": told(lambda: write("/dev/null")),
    "pair": told(socket.socketpair),
    "udp": told(lambda: socket.socket(socket.AF_INET, socket.SOCK_DGRAM).bind(("127.0.0.1", 0))),
    "own limit": told(lambda: resource.setrlimit(resource.RLIMIT_CORE, (0, 0))),
    "own priority": told(lambda: os.nice(1)),
    "thread": told(threading.Thread(target=int).start),
    "write elsewhere": told(lambda: write(f"{other}/new")),
    "remove elsewhere": told(lambda: os.unlink(there)),
    "truncate elsewhere": told(lambda: os.truncate(there, 0)),
    "child": subprocess.run([sys.executable, "-c", child], stderr=-1).stderr.decode(),
    "signal": told(lambda: os.kill(victim, 0)),
    "read": open(there).read(),
    "mode": told(lambda: os.chmod(there, 0)),
    "mode by descriptor": told(lambda: os.fchmod(os.open(there, os.O_RDONLY), 0)),
    "owner": told(lambda: os.chown(there, os.getuid(), os.getgid())),
    "times": told(lambda: os.utime(there, (1, 1))),
    "attribute": told(lambda: os.setxattr(there, "user.deck", b"x")),
    "limit": told(lambda: resource.prlimit(victim, resource.RLIMIT_CPU, (1, 1))),
    "priority": told(lambda: os.setpriority(os.PRIO_PROCESS, victim, 19)),
    "priority of all": told(lambda: os.setpriority(os.PRIO_USER, 0, 19)),
    "affinity": told(lambda: os.sched_setaffinity(victim, {0})),
    "scheduler": told(lambda: os.sched_setscheduler(victim, os.SCHED_IDLE, os.sched_param(0))),
    "idle disk": told(lambda: call(IOPRIO_SET, 1, victim, 3 << 13)),
    "trace": told(lambda: call(PTRACE, 0x4206, victim, 0, 0)),
    "namespace": told(lambda: call(UNSHARE, 0x10000000)),
    "socket": told(connect),
    "datagram": told(datagram),
    "terminal": told(typed),
    "fast open": told(fast_open),
    "multipath": told(multipath),
    "owner of a file": told(lambda: signal_by_file(9, lambda fd: fcntl.fcntl(fd, 8, victim))),
    "owner by ioctl": told(
        lambda: signal_by_file(9, lambda fd: fcntl.ioctl(fd, 0x8901, struct.pack("i", victim)))
    ),
    "lease": told(lambda: fcntl.fcntl(os.open(there, os.O_RDONLY), 1024, fcntl.F_RDLCK)),
    "shared memory": told(lambda: attach(int(memory))),
    "memory as a file": told(lambda: os.memfd_create("much")),
}))
"""
CALLS = {
    "x86_64": {"IOPRIO_SET": 251, "PTRACE": 101, "UNSHARE": 272},
    "aarch64": {"IOPRIO_SET": 30, "PTRACE": 117, "UNSHARE": 97},
}
LIBC = ctypes.CDLL(None, use_errno=True)
OWN = ("write", "rename", "copy", "null", "pair", "udp", "own limit", "own priority", "thread")


@dataclass(frozen=True)
class Tried:
    """What a confined process could do, and what became of what it tried to harm."""

    told: dict[str, str]
    before: object
    after: object


def state(there: Path, victim: int) -> object:
    """Everything of a file and a process that could have been changed."""
    info = there.stat()
    process = Path(f"/proc/{victim}")
    numbers = process.joinpath("stat").read_text().rpartition(")")[2].split()
    attributes = os.listxattr(there)
    return (
        (stat.S_IMODE(info.st_mode), info.st_uid, info.st_gid, info.st_mtime_ns, attributes),
        (numbers[0] not in "TtZX", numbers[16]),
        process.joinpath("limits").read_text(),
        sorted(os.sched_getaffinity(victim)),
        os.sched_getscheduler(victim),
    )


@pytest.fixture(scope="module")
def tried() -> Tried:
    with tempfile.TemporaryDirectory(dir="/tmp") as place:
        own, other = Path(place, "own"), Path(place, "other")
        own.mkdir()
        other.mkdir()
        there = other / "there"
        there.write_text("text")
        sleeping = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
        listening = socket.socket(socket.AF_UNIX)
        listening.bind(str(other / "socket"))
        listening.listen()
        hearing = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        hearing.bind(str(other / "datagrams"))
        ours, terminal = os.openpty()
        server = socket.create_server(("127.0.0.1", 0))
        # IPC_PRIVATE
        memory = LIBC.shmget(0, 4096, 0o600)
        before = state(there, sleeping.pid)
        text = TRIES
        for name, number in CALLS[os.uname().machine].items():
            text = text.replace(name, str(number))
        numbers = (server.getsockname()[1], memory)
        arguments = [str(own), str(other), str(sleeping.pid), os.ttyname(terminal)]
        arguments += map(str, numbers)
        done = subprocess.run([sys.executable, "-c", text, *arguments], stdout=-1, check=True)
        after = state(there, sleeping.pid)
        sleeping.communicate(b"\n")
        for one in (listening, hearing, server):
            one.close()
        # IPC_RMID
        LIBC.shmctl(memory, 0, None)
        os.close(ours)
        os.close(terminal)
        return Tried(json.loads(done.stdout), before, after)


def test_what_a_confined_process_may_do(tried: Tried) -> None:
    assert {name: tried.told[name] for name in OWN} == dict.fromkeys(OWN, "done")


def test_what_it_may_not(tried: Tried) -> None:
    kind = confinement()
    if kind is Confinement.NONE:
        return
    for elsewhere in ("write elsewhere", "remove elsewhere", "truncate elsewhere"):
        assert tried.told[elsewhere] == "refused: PermissionError"
    assert tried.told["read"] == "text"
    assert "Permission" in tried.told["child"] or "not permitted" in tried.told["child"]
    assert tried.told["signal"].startswith("refused") == (kind is Confinement.FULL)


@pytest.mark.parametrize(
    "way",
    [
        "attribute", "limit", "priority", "priority of all", "affinity", "scheduler", "idle disk",
        "trace", "namespace", "socket", "datagram", "terminal", "fast open", "multipath",
        "owner of a file", "owner by ioctl", "lease", "shared memory", "memory as a file",
    ],
)  # fmt: skip
def test_no_way_out(way: str, tried: Tried) -> None:
    assert tried.told[way].startswith("refused")


def test_nothing_else_is_harmed(tried: Tried) -> None:
    assert tried.after == tried.before

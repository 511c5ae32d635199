"""What is in a cell reaches no further than it may, and neither do its children.

All that it tries to harm stands for the judge: a file, a process, sockets and a terminal in the same room.
"""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from course.grade.walls import bubblewrap_for, cell, room
from course.lessons.catalog import SHIPPED
from course.lessons.lesson import LessonFolder

pytestmark = pytest.mark.machine("bubblewrap")

IN_THE_ROOM = """
import json, os, resource, socket, stat, subprocess, sys

place, there, *in_cell = sys.argv[1:]
for _ in range(50):  # So that the number of the next is nobody's in a cell.
    subprocess.run(["true"])
victim = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
listening, hearing = socket.socket(socket.AF_UNIX), socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
listening.bind(f"{place}/run/socket")
listening.listen()
hearing.bind(f"{place}/run/datagrams")
ours, terminal = os.openpty()

def state():
    info, process = os.stat(there), f"/proc/{victim.pid}"
    numbers = open(f"{process}/stat").read().rpartition(")")[2].split()
    return [
        [stat.S_IMODE(info.st_mode), info.st_uid, info.st_gid, info.st_mtime_ns],
        [os.listxattr(there), os.listdir(place)],
        [numbers[0] not in "TtZX", numbers[16]],
        open(f"{process}/limits").read(),
        sorted(os.sched_getaffinity(victim.pid)),
        os.sched_getscheduler(victim.pid),
    ]

before = state()
done = subprocess.run([*in_cell, place, there, str(victim.pid), os.ttyname(terminal)], stdout=-1)
print(json.dumps([json.loads(done.stdout), before, state()]))
victim.kill()
"""
IN_THE_CELL = """
import ctypes, fcntl, json, os, resource, shutil, socket, subprocess, sys, termios, threading

place, there, victim, terminal = sys.argv[1:]
own, victim = f"{place}/nodes", int(victim)
libc = ctypes.CDLL(None, use_errno=True)

def told(act):
    try:
        act()
    except (OSError, ValueError) as error:
        return f"refused: {type(error).__name__}"
    return "done"

def call(name, *arguments):
    if getattr(libc, name)(*arguments) != 0:
        raise OSError(ctypes.get_errno(), "refused")

def write(path):
    open(path, "w").close()

def connect():
    with socket.socket(socket.AF_UNIX) as client:
        client.connect(f"{place}/run/socket")

def datagram():
    socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM).sendto(b"x", f"{place}/run/datagrams")

def typed():
    fcntl.ioctl(os.open(terminal, os.O_RDONLY | os.O_NOCTTY), termios.TIOCSTI, b"x")

child = "import os; open(%r, 'w')" % f"{there}.child"
print(json.dumps({
    "write": told(lambda: write(f"{own}/new")),
    "rename": told(lambda: os.rename(f"{own}/new", f"{own}/newer")),
    "copy": told(lambda: shutil.copy2(f"{own}/newer", f"{own}/copy")),
    "mode": told(lambda: os.chmod(f"{own}/copy", 0o600)),
    "null": told(lambda: write("/dev/null")),
    "pair": told(socket.socketpair),
    "udp": told(lambda: socket.socket(socket.AF_INET, socket.SOCK_DGRAM).bind(("127.0.0.1", 0))),
    "own limit": told(lambda: resource.setrlimit(resource.RLIMIT_CORE, (0, 0))),
    "thread": told(threading.Thread(target=int).start),
    "read": told(lambda: open(there).read()),
    "write elsewhere": told(lambda: write(f"{there}.new")),
    "write in place": told(lambda: write(f"{place}/run/new")),
    "remove elsewhere": told(lambda: os.unlink(there)),
    "truncate elsewhere": told(lambda: os.truncate(there, 0)),
    "child": f"refused: {subprocess.run([sys.executable, '-c', child], stderr=-1).stderr.decode()}",
    "signal": told(lambda: os.kill(victim, 0)),
    "signal to all": told(lambda: os.kill(-1, 9)),
    "mode elsewhere": told(lambda: os.chmod(there, 0)),
    "owner": told(lambda: os.chown(there, os.getuid(), os.getgid())),
    "times": told(lambda: os.utime(there, (1, 1))),
    "attribute": told(lambda: os.setxattr(there, "user.deck", b"x")),
    "limit": told(lambda: resource.prlimit(victim, resource.RLIMIT_CPU, (1, 1))),
    "priority": told(lambda: os.setpriority(os.PRIO_PROCESS, victim, 19)),
    "affinity": told(lambda: os.sched_setaffinity(victim, {0})),
    "scheduler": told(lambda: os.sched_setscheduler(victim, os.SCHED_IDLE, os.sched_param(0))),
    "trace": told(lambda: call("ptrace", 0x4206, victim, 0, 0)),
    "memory": told(lambda: open(f"/proc/{victim}/mem", "rb")),
    "environment": told(lambda: open(f"/proc/{victim}/environ", "rb").read()),
    "way in": told(lambda: os.listdir(f"/proc/{victim}/root")),
    "settings": told(lambda: open("/proc/sys/kernel/core_pattern", "w")),
    "namespace": told(lambda: call("unshare", 0x10000000)),
    "mount": told(lambda: call("mount", b"none", place.encode(), b"tmpfs", 0, None)),
    "socket": told(connect),
    "datagram": told(datagram),
    "terminal": told(typed),
    "device": told(lambda: write("/dev/new")),
    "place": told(lambda: os.listdir(f"{place}/own")),
    "home": told(lambda: write(os.path.expanduser("~/new"))),
}))
os.setpriority(os.PRIO_USER, 0, 19)
"""
OWN = ("write", "rename", "copy", "mode", "null", "pair", "udp", "own limit", "thread", "read")


@dataclass(frozen=True)
class Tried:
    """What is possible in a cell, and what became of what was to be harmed."""

    told: dict[str, str]
    before: object
    after: object


@pytest.fixture(scope="module")
def tried(tmp_path_factory: pytest.TempPathFactory) -> Tried:
    lesson, place = LessonFolder(SHIPPED / "01-hello"), tmp_path_factory.mktemp("place")
    for name in ("nodes", "own", "run"):
        (place / name).mkdir()
    bwrap = bubblewrap_for(lesson)
    python = (sys.executable, "-c")
    in_cell = (*cell(bwrap, place, [place / "nodes"]), *python, IN_THE_CELL)
    seen = str(lesson.path / "checks.py")
    command = (*room(bwrap, lesson, place), *python, IN_THE_ROOM, str(place), seen, *in_cell)
    done = subprocess.run(command, stdout=subprocess.PIPE, check=True, timeout=60)
    return Tried(*json.loads(done.stdout))


def test_what_may_be_done_in_a_cell(tried: Tried) -> None:
    assert {name: tried.told[name] for name in OWN} == dict.fromkeys(OWN, "done")


def test_nothing_else(tried: Tried) -> None:
    others = {name: words for name, words in tried.told.items() if name not in OWN}
    assert [name for name, words in others.items() if not words.startswith("refused")] == []
    assert "Read-only" in others["child"]


def test_nothing_else_is_harmed(tried: Tried) -> None:
    assert tried.after == tried.before


def test_other_learners_folders_are_out_of_sight(tmp_path: Path) -> None:
    lesson, place = LessonFolder(SHIPPED / "01-hello"), tmp_path / "place"
    place.mkdir()
    others = Path(__file__).parent
    looks = ("python3", "-c", "import os, sys; print(os.listdir(sys.argv[1]))", str(others))
    for apart, seen in (([], True), ([others], False)):
        done = subprocess.run((*room(bubblewrap_for(lesson), lesson, place, apart), *looks), stdout=-1, check=True)
        assert (Path(__file__).name in done.stdout.decode()) is seen

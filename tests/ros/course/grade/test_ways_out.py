"""A learner's file tries to get out of its grading: whatever it aims at is unharmed.

All that it aims at is the test's own: a session, a process, a file, sockets.
"""

from __future__ import annotations

import os
import shutil
import socket
import stat
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from course.grade.grades import Grade, GradeState
from course.grade.grading import Domains, Terms, grade_all
from course.grade.walls import Walls, walls_for
from launcher.processes.confinement import Confinement, confinement
from launcher.rundir import run_dir
from tests.ros.course.grade.lessons import handed_in, log_lesson
from tests.ros.supervised import SLEEPER, Launch, running_pid

pytestmark = [pytest.mark.timeout(300), pytest.mark.nightly]

TRIES = """
import os, resource, signal, socket, sys, time
from pathlib import Path
sys.path.insert(0, DECK)

SESSION, VICTIM, THERE, SOCKETS, MINE, OTHERS = TARGETS

def look():
    # Where no room of its own can be had, everything is seen.
    if OTHERS and Path(OTHERS).read_text():
        print("wild")

def exchange():
    from launcher.control.protocol import VERSION, encode
    from launcher.control.socket import connect
    client = connect(Path(SESSION))
    client.setblocking(True)
    client.sendall(encode({"deck": VERSION}))
    client.sendall(encode({"id": 1, "op": "exchange", "node": "node", "run": MINE}))
    client.settimeout(2)
    client.recv(1)
    time.sleep(1)

def say(kind, address):
    with socket.socket(socket.AF_UNIX, kind) as client:
        client.settimeout(2)
        client.connect(address)
        client.sendall(b"out")

def pair():
    socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)[0].sendto(b"out", f"{SOCKETS}/datagrams")

for way in (
    exchange,
    lambda: say(socket.SOCK_STREAM, f"{SOCKETS}/stream"),
    lambda: say(socket.SOCK_STREAM, f"{chr(0)}{SOCKETS}/abstract"),
    lambda: say(socket.SOCK_DGRAM, f"{SOCKETS}/datagrams"),
    pair,
    lambda: resource.prlimit(VICTIM, resource.RLIMIT_CPU, (1, 1)),
    lambda: os.setpriority(os.PRIO_PROCESS, VICTIM, 19),
    lambda: os.setpriority(os.PRIO_USER, os.getuid(), 19),
    lambda: os.sched_setscheduler(VICTIM, os.SCHED_IDLE, os.sched_param(0)),
    lambda: os.kill(VICTIM, signal.SIGKILL),
    lambda: os.chmod(THERE, 0),
    lambda: os.fchmod(os.open(THERE, os.O_RDONLY), 0),
    lambda: os.utime(THERE, (1, 1)),
    lambda: os.chown(THERE, os.getuid(), os.getgid()),
    lambda: os.setxattr(THERE, "user.deck", b"x"),
    lambda: open(THERE, "w"),
    look,
):
    try:
        way()
    except Exception as error:
        print(type(error).__name__, error)
print("ready")
time.sleep(1000)
"""
FROM_OUTSIDE = "import pathlib, time; pathlib.Path({path!r}).touch(); time.sleep(1000)"


@dataclass(frozen=True)
class Targets:
    """What it aims at."""

    place: Path
    victim: subprocess.Popen[bytes]
    listening: tuple[socket.socket, ...]

    @property
    def there(self) -> Path:
        return self.place / "there"

    def state(self) -> object:
        """All that could have been done to the file and the process."""
        info = self.there.stat()
        numbers = Path(f"/proc/{self.victim.pid}/stat").read_text().rpartition(")")[2].split()
        return (
            (stat.S_IMODE(info.st_mode), info.st_mtime_ns, info.st_size),
            os.listxattr(self.there),
            (numbers[0] not in "TtZX", numbers[16], os.sched_getscheduler(self.victim.pid)),
            Path(f"/proc/{self.victim.pid}/limits").read_text(),
        )

    def reached(self) -> list[bytes]:
        """What has come on the sockets."""
        found = []
        for each in self.listening:
            each.setblocking(False)
            try:
                if each.type == socket.SOCK_STREAM:
                    found.append(each.accept()[0].recv(10))
                else:
                    found.append(each.recv(10))
            except BlockingIOError:
                pass
        return found


@pytest.fixture
def targets() -> Iterator[Targets]:
    # Not among the folders that are hidden inside walls: a file at a place that is not.
    with tempfile.TemporaryDirectory(dir=Path(__file__).parent, prefix="targets-") as folder:
        sockets = tempfile.mkdtemp()
        place = Path(folder)
        (place / "there").write_text("text")
        (place / "sockets").symlink_to(sockets)
        listening = []
        for kind, address in (
            (socket.SOCK_STREAM, f"{sockets}/stream"),
            (socket.SOCK_STREAM, f"\0{sockets}/abstract"),
            (socket.SOCK_DGRAM, f"{sockets}/datagrams"),
        ):
            one = socket.socket(socket.AF_UNIX, kind)
            one.bind(address)
            if kind == socket.SOCK_STREAM:
                one.listen()
            listening.append(one)
        victim = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
        try:
            yield Targets(place, victim, tuple(listening))
        finally:
            victim.kill()
            victim.communicate()
            for one in listening:
                one.close()
            shutil.rmtree(sockets)


@pytest.mark.parametrize("walled", [True, False])
async def test_nothing_outside_is_harmed(
    walled: bool, start: Launch, targets: Targets, tmp_path: Path, other_domain: int
) -> None:
    client = await start({"node": {"exec": SLEEPER}})
    pid = await running_pid(client, "node")
    (tmp_path / "mine.py").write_text(FROM_OUTSIDE.format(path=str(tmp_path / "out")))
    aims = (
        str(run_dir() / client.session.run_id),
        targets.victim.pid,
        str(targets.there),
        str((targets.place / "sockets").readlink()),
        str(tmp_path / "mine.py"),
        str(targets.place / "boris" / "talker.py") if walled else "",
    )
    deck = str(Path(__file__).parents[4])
    text = TRIES.replace("TARGETS", repr(aims)).replace("DECK", repr(deck))
    lesson = log_lesson(tmp_path / "lesson")
    before = targets.state()
    terms = Terms(lesson, walls=walls_for(lesson) if walled else Walls.NONE, within_s=60.0)
    if terms.walls is Walls.NONE:
        text = text.replace(repr(aims[-1]), repr(""))
    # Not in a folder that is hidden in any case, either.
    chosen = handed_in(lesson, targets.place, anna=text, boris="print('ready'); input()")
    coming = grade_all(terms, chosen, domains=Domains([other_domain]))
    grades: list[Grade] = [grade async for _, grade in coming if grade.student == "anna"]
    assert grades[0].state is GradeState.PASSED, [step.message for step in grades[0].steps]
    if confinement() is Confinement.NONE and terms.walls is Walls.NONE:
        return
    assert targets.state() == before
    assert targets.reached() == []
    assert not (tmp_path / "out").exists()
    assert await running_pid(client, "node") == pid

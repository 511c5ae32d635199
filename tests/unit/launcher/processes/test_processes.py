"""Processes: their ends, signals, numbers, ports and interrupts."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from launcher.processes import table
from launcher.processes.exit import UNSEEN, Reaper
from launcher.processes.table import read_process
from tests.own_numbers import run_with_own_numbers
from tests.waiting import until

WAITS = """
import os, signal, threading
from launcher.processes.ending import ENDING, stop_by_signals

def send(number):
    os.kill(os.getpid(), number)

for round in range(300):
    stop = stop_by_signals()
    threading.Timer(0.0001 * (round % 7), send, (ENDING[round % 3],)).start()
    while not stop.wait(0):
        pass
print("ended each time")
"""
"""It looks without a pause: most signals come while it holds a lock of the event."""


def test_it_ends_while_it_looks_whether_it_is_to_end() -> None:
    ran = subprocess.run([sys.executable, "-c", WAITS], capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stdout) == (0, "ended each time\n"), ran.stderr


def child() -> tuple[int, int]:
    pid = os.fork()
    if pid == 0:
        signal.pause()
        os._exit(0)
    process = read_process(pid)
    assert process is not None
    return pid, process.started_ticks


def await_end(pid: int, flags: int = 0) -> None:
    """Wait for the end of a child, and reap it unless told otherwise."""
    os.waitid(os.P_PID, pid, os.WEXITED | flags)


async def test_the_end_of_who_was_reaped_by_somebody_else_is_known_as_unseen() -> None:
    reaper, (pid, started) = Reaper(), child()
    ended = reaper.exit_of(pid, started)
    os.kill(pid, signal.SIGKILL)
    await_end(pid)
    reaper.look_for(pid, started)
    assert ended.result() == UNSEEN


HOUSE = Path(__file__).parents[4]
RUN = """
try:
    run(work())
except KeyboardInterrupt:
    print("interrupted")
"""
A_LOOP_THAT_IS_INTERRUPTED_WHILE_IT_IS_MADE = """
import asyncio, signal
from launcher.processes.interrupts import run

class Loop(asyncio.SelectorEventLoop):
    def __init__(self):
        signal.raise_signal(signal.SIGINT)
        super().__init__()

class Policy(asyncio.DefaultEventLoopPolicy):
    _loop_factory = Loop

async def work():
    raise AssertionError("the work began")

asyncio.set_event_loop_policy(Policy())
"""
WORK_THAT_IS_INTERRUPTED = """
import asyncio, signal
from launcher.processes.interrupts import run

async def work():
    try:
        signal.raise_signal(signal.SIGINT)
        await asyncio.sleep(60)
    finally:
        print("tidied")

"""


def ran(program: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-c", program], cwd=HOUSE, capture_output=True, text=True, check=False)


@pytest.mark.parametrize(
    ("program", "printed"),
    [
        (A_LOOP_THAT_IS_INTERRUPTED_WHILE_IT_IS_MADE + RUN, "interrupted\n"),
        (WORK_THAT_IS_INTERRUPTED + RUN, "tidied\ninterrupted\n"),
    ],
    ids=["while its loop is made", "while it works"],
)
def test_a_command_that_is_interrupted(program: str, printed: str) -> None:
    ended = ran(program)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, printed, "")


@pytest.mark.machine("namespaces")
def test_a_signal_is_not_for_whoever_has_got_the_number() -> None:
    told = run_with_own_numbers(
        """
        import os, signal, time
        from launcher.processes.signal import lives, send
        from launcher.processes.table import read_process

        def sleeper():
            pid = os.fork()
            if pid == 0:
                signal.pause()
            return pid

        meant = read_process(sleeper())
        print(lives(meant))
        send(meant, signal.SIGKILL)
        os.waitpid(meant.pid, 0)
        time.sleep(0.02)  # The clock of starts has ticks of 10 ms.
        give_next(meant.pid)
        other = read_process(sleeper())
        print(other.pid == meant.pid, lives(meant))
        send(meant, signal.SIGKILL)
        print(os.waitpid(other.pid, os.WNOHANG))
        send(other, signal.SIGTERM)
        print(os.waitpid(other.pid, 0)[1] == signal.SIGTERM)
        """
    )
    assert told.splitlines() == ["True", "True False", "(0, 0)", "True"]


def talker(program: str) -> subprocess.Popen[bytes]:
    """Start a program and return once it has said something."""
    command = [sys.executable, "-I", "-c", textwrap.dedent(program)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE)
    assert process.stdout is not None
    process.stdout.read(1)
    return process


async def test_a_process_is_alive_while_one_of_its_threads_is() -> None:
    """Its first thread has ended: the kernel calls it a zombie, and it still works."""
    program = """
        import ctypes, platform, threading, time
        threading.Thread(target=time.sleep, args=(1000,)).start()
        print("ready", flush=True)
        ctypes.CDLL(None).syscall({"x86_64": 60, "aarch64": 93}[platform.machine()], 0)
    """
    process = talker(program)

    def state() -> str:
        found = read_process(process.pid)
        return found.state if found else ""

    await until(lambda: state() == "Z", "the end of its first thread")
    found = read_process(process.pid)
    assert found is not None
    assert not found.zombie
    process.send_signal(signal.SIGKILL)

    def ended() -> bool:
        found = read_process(process.pid)
        return found is not None and found.zombie

    await until(ended, "the end of all of it")
    process.communicate()


def test_what_proc_hides_is_not_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """As where /proc is mounted with hidepid=1: it names the processes of others, and lets nobody look at them."""
    read = table._read

    def hidden(pid: int, file_name: str) -> bytes:
        if pid == 1:
            raise PermissionError(errno.EPERM, "hidden")
        return read(pid, file_name)

    monkeypatch.setattr(table, "_read", hidden)
    seen = [process.pid for process in table.processes()]
    assert os.getpid() in seen
    assert 1 not in seen

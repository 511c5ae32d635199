"""What /proc tells of processes, in the moments in which it tells little."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap

from launcher.processes.table import RUN_MARK, read_marks, read_process
from tests.waiting import until


def test_a_process_that_is_just_being_executed_has_its_marks() -> None:
    environ = {**os.environ, RUN_MARK: "this run"}
    for _time in range(50):
        # It comes back in the midst of execve(2): the kernel has no environment to show yet.
        process = subprocess.Popen(["sleep", "60"], env=environ)
        marks = read_marks(process.pid)
        process.kill()
        process.wait()
        assert marks is not None
        assert marks.get(RUN_MARK) == "this run"


def test_a_process_without_an_environment_has_no_marks() -> None:
    process = subprocess.Popen(["/bin/sleep", "60"], env={})
    marks = read_marks(process.pid)
    process.kill()
    process.wait()
    assert marks == {}


def test_a_process_that_has_ended_has_none_that_could_be_read() -> None:
    process = subprocess.Popen(["true"])
    process.wait()
    assert read_marks(process.pid) is None


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

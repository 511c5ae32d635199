"""What /proc tells of processes, in the moments in which it tells little."""

from __future__ import annotations

import os
import subprocess

from launcher.processes.table import RUN_MARK, read_marks


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

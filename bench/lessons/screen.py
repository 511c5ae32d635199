"""What the Lesson screen costs at rest, in a real terminal of 120x40, lesson 2 judged meanwhile.

`python -m bench.lessons.screen` opens the lesson from the learner's folder twice: with the starter,
whose first step fails and is judged again every two seconds, and with the solution, whose first
step has passed.
"""

from __future__ import annotations

import os
import shutil
import tempfile
import time
from pathlib import Path

from bench.lessons.own_node import LESSON
from bench.processes import children, command
from bench.screen import at_rest, deck, screen_processes
from tests.e2e.terminal import Terminal

SETTLING_S = 8.0


def judge_of(terminal: Terminal) -> int:
    """Return the judge's pid."""
    (pid,) = (pid for pid in children(terminal.process.pid) if "course.judge" in command(pid))
    return pid


def measured(folder: Path, *, solved: bool) -> None:
    """Open the lesson, and print a row each for the screen and for what judges beside it."""
    own = folder / "course" / LESSON.name
    shutil.copytree(LESSON / "starter", own)
    if solved:
        shutil.copytree(LESSON / "solution", own, dirs_exist_ok=True)
    with deck(folder, str(own / "lesson.yaml")) as terminal:
        terminal.wait_for("Passed." if solved else "seen:", within_s=60)
        time.sleep(SETTLING_S)
        pids = [*screen_processes(terminal), judge_of(terminal)]
        cpu, pss, sent = at_rest(terminal, pids)
    what = "a passed step" if solved else "a step that fails"
    print(f"| {what}: screen, supervisor and judge, CPU of one core | {cpu:.1f} % | 12 % |")
    print(f"| {what}: the same, PSS | {pss:.0f} MB | - |")
    print(f"| {what}: to the terminal | {sent / 1000:.1f} kB/s | - |")


def main() -> None:
    print(f"load of the machine {os.getloadavg()[0]:.1f}\n")
    print("| what | measured | goal |")
    print("| --- | --- | --- |")
    for solved in (False, True):
        with tempfile.TemporaryDirectory() as place:
            measured(Path(place), solved=solved)


if __name__ == "__main__":
    main()

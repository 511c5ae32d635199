"""How long `deck grade` takes for the solution of lesson 2, from the command to its end.

`python -m bench.lessons.grading`: the whole command, so many times in a row; most of it are the
windows of the checks, three seconds of a rate for example.
"""

from __future__ import annotations

import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROUNDS = int(os.environ.get("BENCH_ROUNDS", "7"))
LESSON = Path(__file__).parents[2] / "lessons" / "02-sonar-safety"
GOAL_S = 15.0


def graded(folder: Path) -> float:
    """Grade the folder, which passes; return how long it took."""
    began = time.monotonic()
    subprocess.run(
        [sys.executable, "-m", "tui", "grade", str(LESSON), str(folder)], check=True, stdout=subprocess.DEVNULL
    )
    return time.monotonic() - began


def main() -> None:
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place, "anna")
        shutil.copytree(LESSON / "starter", folder)
        shutil.copytree(LESSON / "solution", folder, dirs_exist_ok=True)
        took = [graded(folder) for _round in range(ROUNDS)]
    print("| what | measured | goal |")
    print("| --- | --- | --- |")
    median = statistics.median(took)
    what = f"lesson 2's solution graded, median of {len(took)}"
    print(f"| {what} | {median:.1f} s | {GOAL_S:.0f} s |")
    print(f"| the longest | {max(took):.1f} s | - |")


if __name__ == "__main__":
    main()

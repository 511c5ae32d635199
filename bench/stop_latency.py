"""The time from a sonar frame below the threshold to the first drive line with speed 0 at the Pico.

`python -m bench.stop_latency` prints a table. This process emulates both devices, on
pseudo-terminals; between them are the nodes of profiles/robot.yaml, and all of lesson 9 runs as
well. Then a bare loop in one process with pyserial only, `bench.bare_reflex`, replaces the nodes.
"""

from __future__ import annotations

import os
import random
import statistics
import sys
import tempfile
import time
from pathlib import Path

from bench.driving import commander, lesson_9, nodes, row, running, wait_for
from bench.emulated import FAR_M, NEAR_M, Pico, Sonar

TRIALS = int(os.environ.get("BENCH_ROUNDS", "200"))


def trials(pico: Pico, front: Sonar, dice: random.Random, count: int) -> list[float]:
    """Return the seconds from frame to line, for each trial."""
    taken = []
    for _ in range(count):
        wait_for(pico.driven, time.monotonic())
        time.sleep(dice.uniform(0.1, 0.3))
        front.told_s.clear()
        front.metres = NEAR_M
        while NEAR_M not in front.told_s:
            time.sleep(0.001)
        told_s = front.told_s[NEAR_M]
        taken.append(wait_for(pico.stopped, told_s) - told_s)
        front.metres = FAR_M
    return taken


def main() -> None:
    """Measure the nodes and the loop."""
    dice = random.Random(1)
    with tempfile.TemporaryDirectory() as name, lesson_9():
        folder = Path(name)
        bare = [sys.executable, "-m", "bench.bare_reflex", folder / "tof_front", folder / "pico"]
        with Pico(folder / "pico") as pico, Sonar(folder / "tof_front") as front, Sonar(folder / "tof_rear"):
            with nodes(folder), commander():
                robot = trials(pico, front, dice, TRIALS)
            with running(list(map(str, bare))):
                alone = trials(pico, front, dice, TRIALS)
    print(f"{TRIALS} stops each; load of the machine {os.getloadavg()[0]:.1f}\n")
    print("| | median, ms | 99th percentile, ms | longest, ms | goals, ms |")
    print("| --- | --- | --- | --- | --- |")
    print(row("the robot's nodes, lesson 9 beside", robot, 25, 60))
    print(row("one process with pyserial, lesson 9 beside", alone))
    ratio = statistics.median(robot) / statistics.median(alone)
    print(f"| ratio of the medians | {ratio:.1f} | | | |")


if __name__ == "__main__":
    main()

"""Unplugging a cable while the robot drives, and plugging it in: time to stop and to drive again.

`python -m bench.cable` prints a table. Only the cable is touched; a commander sends commands all
the time.
"""

from __future__ import annotations

import os
import random
import statistics
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

from bench.driving import commander, nodes, wait_for
from bench.emulated import Pico, Sonar

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from bench.emulated import Line

TRIALS = int(os.environ.get("BENCH_ROUNDS", "15"))
GOAL_S = 3.0


def pull(
    line: Line, pico: Pico, stands: Callable[[float], float | None] | None, count: int
) -> tuple[list[float], list[float]]:
    """Return seconds from unplugging until it stands, and from plugging in until it drives."""
    dice = random.Random(3)
    stood, drove = [], []
    for _ in range(count):
        wait_for(pico.driven, time.monotonic())
        pulled_s = time.monotonic()
        line.unplug()
        if stands is not None:
            stood.append(wait_for(stands, pulled_s) - pulled_s)
        time.sleep(dice.uniform(0.2, 4.0))
        back_s = time.monotonic()
        line.plug()
        drove.append(wait_for(pico.driven, back_s) - back_s)
    return stood, drove


def row(name: str, seconds: Sequence[float], goal: str) -> str:
    """Return one line of the table."""
    return f"| {name} | {statistics.median(seconds):.2f} | {max(seconds):.2f} | {goal} |"


def main() -> None:
    """Unplug both cables, and print the results."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        with (
            Pico(folder / "pico") as pico,
            Sonar(folder / "tof_front") as front,
            Sonar(folder / "tof_rear"),
            nodes(folder),
            commander(),
        ):
            stood, drove = pull(front.line, pico, pico.stopped, TRIALS)
            _, drove_pico = pull(pico.line, pico, None, TRIALS)
    print(f"{TRIALS} pulls each, for 0.2 to 4 s; load of the machine {os.getloadavg()[0]:.1f}\n")
    print("| | median, s | longest, s | goal, s |")
    print("| --- | --- | --- | --- |")
    print(row("the front sonar's cable out: stop at the Pico", stood, "-"))
    print(row("the front sonar's cable back: driving", drove, f"{GOAL_S:g}"))
    print(row("the Pico's cable back: driving", drove_pico, f"{GOAL_S:g}"))
    print("\nWith its cable out the Pico stops by itself after 0.25 s (its watchdog).")


if __name__ == "__main__":
    main()
